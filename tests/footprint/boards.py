# SPDX-License-Identifier: MIT
"""Boards on which the decoder fits: their flash and RAM, from their makers' pages, and what the decoder needs, from the
budget. footprint.py writes the table of decoder/docs/boards.md from this; tests/packages/rules.py compares the
packages' manifests with it."""

from dataclasses import dataclass

KB = 1024
SHARE = 0.75  # of flash and of RAM that the decoder may take; the rest is the application's
LEAST_MESH, LEAST_TILE = 64, 32  # vertices: with less a board does not fit
MOST = 10923  # vertices with 16-bit indices
SLOTS = 9  # compact slots of a pack
TILE_OWN_BYTES = 24  # of a slot; MICROTIN_COMPACT_PACK_BYTES in compact_pack.h
PACK_OWN_BYTES = 480  # MICROTIN_PACK_OWN_BYTES in pack.h


@dataclass
class Board:
    name: str
    processor: str
    preset: str  # of the budget
    flash: int  # KB
    ram: int  # KB that data may take
    arduino: tuple  # architectures of its cores
    platformio: str  # development platform


BOARDS = [
    Board("Arduino Uno R3, Nano", "ATmega328P", "avr", 32, 2, ("avr",), "atmelavr"),
    Board("Arduino Leonardo, Pro Micro", "ATmega32U4", "avr", 32, 2.5, ("avr",), "atmelavr"),
    Board("Arduino Mega 2560", "ATmega2560", "avr", 256, 8, ("avr",), "atmelavr"),
    Board("Arduino Zero", "SAMD21G18 (M0+)", "cortex-m0", 256, 32, ("samd",), "atmelsam"),
    Board("Arduino Due", "SAM3X8E (M3)", "cortex-m3", 512, 96, ("sam",), "atmelsam"),
    Board("Arduino Uno R4", "RA4M1 (M4)", "cortex-m4", 256, 32, ("renesas_uno",), "renesas-ra"),
    Board("Arduino Nano 33 BLE", "nRF52840 (M4)", "cortex-m4", 1024, 256, ("mbed_nano", "mbed"), "nordicnrf52"),
    Board("Arduino Portenta C33", "RA6M5 (M33)", "cortex-m33", 2048, 512, ("renesas_portenta",), "renesas-ra"),
    Board("Arduino Portenta H7", "STM32H747 (M7)", "cortex-m7", 2048, 512, ("mbed_portenta",), "ststm32"),
    Board("Arduino Giga R1", "STM32H747 (M7)", "cortex-m7", 2048, 512, ("mbed_giga",), "ststm32"),
    Board("Teensy 4.0", "i.MX RT1062 (M7)", "cortex-m7", 1984, 512, ("avr",), "teensy"),
    Board("Raspberry Pi Pico", "RP2040 (M0+)", "cortex-m0", 2048, 264, ("rp2040", "mbed_rp2040"), "raspberrypi"),
    Board("Nucleo-F031K6", "STM32F031K6 (M0)", "cortex-m0", 32, 4, ("stm32",), "ststm32"),
    Board("Blue Pill", "STM32F103C8 (M3)", "cortex-m3", 64, 20, ("stm32",), "ststm32"),
    Board("Nucleo-F411RE", "STM32F411RE (M4)", "cortex-m4", 512, 128, ("stm32",), "ststm32"),
    Board("micro:bit v1", "nRF51822 (M0)", "cortex-m0", 256, 16, ("nRF5",), "nordicnrf51"),
    Board("micro:bit v2", "nRF52833 (M4)", "cortex-m4", 512, 128, ("nRF5",), "nordicnrf52"),
    Board("Feather nRF52840", "nRF52840 (M4)", "cortex-m4", 1024, 256, ("nrf52",), "nordicnrf52"),
    Board("ESP8266 NodeMCU", "ESP8266 (LX106)", "xtensa", 4096, 80, ("esp8266",), "espressif8266"),
    Board("ESP32-DevKitC", "ESP32 (LX6)", "xtensa", 4096, 320, ("esp32",), "espressif32"),
    Board("ESP32-C3-DevKit", "ESP32-C3 (RV32IMC)", "rv32imc", 4096, 320, ("esp32",), "espressif32"),
    Board("Longan Nano", "GD32VF103CB (RV32IMAC)", "rv32imc", 128, 32, (), "gd32v"),
]
PLATFORMIO_HOSTS = {"native"}  # the host, for unit tests
SMALL = [  # with 16 KB of RAM, which CI emulates
    next(board for board in BOARDS if board.name == "micro:bit v1"),
    Board("ATmega1284P", "AVR", "avr", 128, 16, (), ""),
]
KEPT_TILES, KEPT_VERTICES = 9, 64  # of the pack of tests/firmware/kept.cpp, which both hold in compact slots


def line(budget, kind):
    """Bytes of a workspace for n vertices: the line through two recorded sizes, as (own bytes, bytes a vertex)."""
    run = budget["cortex-m4"]["Os"]["run"]
    few, many = run[f"ram_{kind}_250"], run[f"ram_{kind}_10000"]
    each = (many - few) / 9750
    return few - 250 * each, each


def code(budget, board, use):
    """Bytes of flash; `use` is one of footprint.py's."""
    sizes = budget[board.preset]["Os"][use]
    return sizes["text"] + sizes["rodata"]


def stack(budget, board, use):
    """Bytes of stack; where no compiler writes call graphs, the most of all other devices with 32 bits."""
    name = "stack_" + use
    of = [n["Os"][name] for preset, n in budget.items() if name in n["Os"] and preset not in ("avr", "s390x", "i386")]
    return budget[board.preset]["Os"].get(name, max(of))


def fitting(room, own, each):
    """How many vertices fit in `room` bytes."""
    return min(MOST, max(0, int((room - own) // each)))


def mesh_vertices(budget, board):
    own, each = (a + b for a, b in zip(line(budget, "terrain"), line(budget, "decoder")))
    return fitting(SHARE * board.ram * KB - stack(budget, board, "decoding"), own, each)


def tile_vertices(budget, board):
    """Vertices of a tile of a pack that is kept in compact slots, one of which is decoded at a time."""
    own, each = (a + b for a, b in zip(line(budget, "terrain"), line(budget, "decoder")))
    slot_own, slot_each = line(budget, "narrow")
    stacks = stack(budget, board, "compact_pack") + stack(budget, board, "compact_pack_queries")
    own += PACK_OWN_BYTES + SLOTS * (slot_own + TILE_OWN_BYTES)
    return fitting(SHARE * board.ram * KB - stacks, own, each + SLOTS * slot_each)


def lacks(budget, board, use, vertices, least):
    """What of a board does not suffice: flash, RAM, both or nothing."""
    flash = [] if code(budget, board, use) <= SHARE * board.flash * KB else ["flash"]
    return flash + ([] if vertices >= least else ["RAM"])


def cell(budget, board, use, vertices, least):
    missing = lacks(budget, board, use, vertices, least)
    return "no: " + " and ".join(missing) if missing else f"{vertices:,}"


def fits(budget, board):
    return not lacks(budget, board, "queries", mesh_vertices(budget, board), LEAST_MESH)


def rows(budget):
    for board in BOARDS:
        yield [
            board.name, board.processor, board.preset, f"{board.flash:,}", f"{board.ram:g}",
            f"{code(budget, board, 'queries'):,}",
            cell(budget, board, "queries", mesh_vertices(budget, board), LEAST_MESH),
            f"{code(budget, board, 'compact_pack'):,}",
            cell(budget, board, "compact_pack", tile_vertices(budget, board), LEAST_TILE),
        ]  # fmt: skip


HEAD = ["board", "processor", "sizes from", "flash, KB", "RAM, KB", "flash, decoding and queries", "vertices of a mesh",
        "flash, packs", "vertices of each of nine compact tiles"]  # fmt: skip


def small_rows(budget):
    """What fits in 16 KB of RAM, of which the application has a quarter."""
    kept = f"{KEPT_TILES * KEPT_VERTICES} in {KEPT_TILES} tiles"
    return [[board.name, f"{mesh_vertices(budget, board):,}", kept] for board in SMALL]


SMALL_HEAD = ["device", "vertices of one terrain, mesh or compact", "vertices of a pack, compact slots"]


def architectures(budget):
    """Arduino's architectures that have a board which fits."""
    return {name for board in BOARDS if fits(budget, board) for name in board.arduino}


def platforms(budget):
    """PlatformIO's platforms that have a board which fits."""
    return {board.platformio for board in BOARDS if fits(budget, board)} | PLATFORMIO_HOSTS


def faults_of_limit(budget, least_flash):
    """What is wrong with a limit below which AVR boards are refused, in bytes."""
    for board in BOARDS:
        if board.preset == "avr" and (board.flash * KB >= least_flash) != fits(budget, board):
            yield f"the limit of flash is wrong for {board.name}"
    if code(budget, BOARDS[0], "queries") > least_flash:
        yield "decoding and queries do not fit the least flash that is allowed"
