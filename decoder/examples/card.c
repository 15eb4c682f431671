// SPDX-License-Identifier: MIT
/* A pack on a memory card: the main loop reads and decodes what lies ahead, an interrupt asks for
 * heights. The card is read in sectors of which one is kept, as FatFs does; it is pulled out in
 * flight and put back, after which the file is opened again; one of its tiles is damaged. */
#include "flight.h"
#include "toolchains/board.h"

#define SECTOR 512
#define SLOTS 4
#define CAPACITY 2500 /* microtin info: most vertices of a tile. Smaller tiles: more sectors */
#define STEPS 200     /* of decoding, in a turn of the main loop */

#ifdef COMPACT_SLOTS /* three times as many tiles in the same memory */
#include "microtin/compact_pack.h"
#define TILE_BYTES MICROTIN_COMPACT_BYTES(CAPACITY) /* or what microtin info says */
#define PACK_BYTES MICROTIN_COMPACT_PACK_BYTES(SLOTS, CAPACITY, TILE_BYTES)
#define pack_init(space, pack) \
  microtin_compact_pack_init(space, sizeof(space), SLOTS, CAPACITY, TILE_BYTES, pack)
#define load_with microtin_compact_pack_load_with
#define pack_height_at microtin_compact_pack_height_at
#else
#define PACK_BYTES MICROTIN_PACK_BYTES(SLOTS, CAPACITY)
#define pack_init(space, pack) microtin_pack_init(space, sizeof(space), SLOTS, CAPACITY, pack)
#define load_with microtin_pack_load_with
#define pack_height_at microtin_pack_height_at
#endif

/* --- The card. A file system would find the file's sectors here: f_lseek and f_read, of which each
 * call reads a sector unless it is the one in the window. --- */

struct card {
  uint8_t window[SECTOR];
  uint32_t sector;   /* in the window */
  int32_t filled;    /* bytes of it, -1: none */
  uint8_t is_lost;   /* reading failed: the file is opened again before the next read */
  uint32_t attempts; /* to read a sector */
  uint32_t sectors, reads, bytes;
};

/* Somebody pulls the card out at the 40th sector, and puts it back. */
static int is_out(const struct card* card) {
  return card->attempts > 40 && card->attempts <= 50;
}

static int fill_window(struct card* card, uint32_t sector) {
  if (card->filled >= 0 && card->sector == sector) return 1;
  ++card->attempts;
  card->filled = -1;
  card->sector = sector;
  /* Errors of FatFs are sticky: close, mount and open here. */
  if (card->is_lost) card->is_lost = (uint8_t)(is_out(card) || !open_card());
  if (!card->is_lost && !is_out(card)) card->filled = read_sector(sector, card->window);
  card->is_lost = (uint8_t)(card->filled < 0);
  if (card->is_lost) return 0;
  ++card->sectors;
  return 1;
}

/* A microtin_read. The pack aligns its reads, so that each lies within one sector. */
static int32_t read_card(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
  struct card* card = (struct card*)context;
  const int32_t first = (int32_t)(offset % SECTOR);
  int32_t count = 0;
  if (!fill_window(card, (uint32_t)(offset / SECTOR))) return -1;
  while ((size_t)count < size && first + count < card->filled) {
    buffer[count] = card->window[first + count];
    ++count;
  }
  ++card->reads;
  card->bytes += (uint32_t)count;
  return count;
}

/* --- What the interrupt and the main loop tell each other. --- */

static microtin_pack* pack;

/* All of it is volatile: no compiler may move what is written past a flag that tells of it. */
static volatile struct {
  uint8_t is_set;    /* the vehicle is at a place; the interrupt may look */
  uint8_t is_wanted; /* all is decoded that can be: the next result is the last one */
  int64_t x, y;
  microtin_query_result result;
  int32_t height; /* that was answered here */
  uint8_t has_height;
  uint32_t early, wrong; /* answers before all was decoded; heights that changed */
} vehicle;

/* Some thousand times a second, at any moment of the service. */
static void on_tick(void) {
  static uint32_t hint;
  microtin_query_result result;
  int32_t height;
  if (!vehicle.is_set) return;
  result = pack_height_at(pack, vehicle.x, vehicle.y, &hint, &height);
  if (result == MICROTIN_QUERY_OK) {
    if (vehicle.has_height && height != vehicle.height) ++vehicle.wrong;
    vehicle.height = height;
    vehicle.has_height = 1;
  }
  vehicle.result = result;
  if (!vehicle.is_wanted) ++vehicle.early;
  vehicle.is_wanted = 0;
}

static void go_to(const microtin_segment* segment) {
  vehicle.is_set = 0; /* no interrupt sees half of a place */
  vehicle.x = segment->x;
  vehicle.y = segment->y;
  vehicle.has_height = 0;
  vehicle.is_set = 1;
}

static void wait_for_answer(void) {
  vehicle.is_wanted = 1;
  while (vehicle.is_wanted) {
  }
}

/* --- The main loop. --- */

/* Turns of the loop until the segment is known as far as it can be. Counts those in which the card
 * did not respond: the vehicle flies on by the tiles that are there. 0: it is no pack. */
static int serve(const microtin_segment* segment, struct card* card, uint32_t* failures) {
  for (;;) {
    switch (load_with(pack, segment, read_card, card, STEPS)) {
      case MICROTIN_STATUS_OK:
      case MICROTIN_STATUS_BAD_TILES:
        return 1;
      case MICROTIN_STATUS_IO:
        ++*failures;
        break; /* read_card opens it again; another card: microtin_pack_reset */
      case MICROTIN_STATUS_NEED_INPUT:
      case MICROTIN_STATUS_STEP_LIMIT:
        break;
      default:
        return 0;
    }
    /* Other tasks have their turn here. */
  }
}

static void say(const char* what, uint32_t number) {
  print(what);
  print_number((int32_t)number);
  print("\n");
}

static void report(const struct card* card, uint32_t failures) {
  uint32_t i, tile, why;
  for (i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    if (microtin_pack_bad_tile(pack, i, &tile, &why) == MICROTIN_STATUS_OK)
      say("damaged: tile ", tile);
  }
  say("turns without a card: ", failures);
  say("heights that changed: ", vehicle.wrong);
  print(vehicle.early != 0 ? "interrupts came during the service\n" : "no interrupt came\n");
  say("reads: ", card->reads);
  say("bytes asked for: ", card->bytes);
  say("bytes of sectors read: ", SECTOR * card->sectors);
}

int firmware_main(void) {
  static uint64_t workspace[(PACK_BYTES + 7) / 8];
  static struct card card;
  const microtin_segment origin = {0, 0, 0, 0};
  uint32_t failures = 0;
  microtin_pack_info info;
  int32_t i;
  card.filled = -1;
  if (!open_card()) return 1;
  if (pack_init(workspace, &pack) != MICROTIN_STATUS_OK) return 2;
  microtin_pack_align_reads(pack, SECTOR);
  go_to(&origin);
  start_ticks(on_tick);
  if (!serve(&origin, &card, &failures)) return 3;
  if (microtin_pack_get_info(pack, &info) != MICROTIN_STATUS_OK) return 4;
  for (i = 0; i < FLIGHT_PLACES; ++i) {
    const microtin_segment segment = flight_segment(i, &info);
    go_to(&segment);
    if (!serve(&segment, &card, &failures)) return 5;
    wait_for_answer();
    print_place(i, vehicle.result, vehicle.height);
  }
  report(&card, failures);
  return vehicle.wrong == 0 ? 0 : 6;
}
