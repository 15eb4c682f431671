// SPDX-License-Identifier: MIT
/* A pack on a card in memory with FatFs, of which each 23rd read fails: after a failure the file is
 * opened again, as decoder/docs/packs.md describes. */
#include "diskio.h"
#include "ff.h" /* before diskio.h, which needs its types: by the command in run */
#include "tests/checkouts/expected.h"

#define SECTORS 8192

static uint8_t card[SECTORS][512];
static uint32_t reads, failures;
static int fails;

DSTATUS disk_initialize(BYTE drive) {
  (void)drive;
  return 0;
}

DSTATUS disk_status(BYTE drive) {
  (void)drive;
  return 0;
}

DRESULT disk_read(BYTE drive, BYTE* buffer, LBA_t sector, UINT count) {
  (void)drive;
  if (sector + count > SECTORS) return RES_PARERR;
  if (fails && ++reads % 23 == 0) {
    ++failures;
    return RES_ERROR;
  }
  memcpy(buffer, card[sector], count * (size_t)512);
  return RES_OK;
}

DRESULT disk_write(BYTE drive, const BYTE* buffer, LBA_t sector, UINT count) {
  (void)drive;
  if (sector + count > SECTORS) return RES_PARERR;
  memcpy(card[sector], buffer, count * (size_t)512);
  return RES_OK;
}

DRESULT disk_ioctl(BYTE drive, BYTE command, void* answer) {
  (void)drive;
  if (command == GET_SECTOR_COUNT) *(LBA_t*)answer = SECTORS;
  if (command == GET_SECTOR_SIZE) *(WORD*)answer = 512;
  if (command == GET_BLOCK_SIZE) *(DWORD*)answer = 1;
  return RES_OK;
}

DWORD get_fattime(void) {
  return (DWORD)1 << 21 | (DWORD)1 << 16;
}

typedef struct file {
  FIL handle;
  int is_open;
  uint32_t opened;
} file;

/* A microtin_read. Errors of FatFs are sticky. */
static int32_t read_file(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
  file* const f = (file*)context;
  UINT taken = 0;
  if (!f->is_open) {
    if (f_open(&f->handle, "AREA.MTP", FA_READ) != FR_OK) return -1;
    f->is_open = 1;
    ++f->opened;
  }
  if (f_lseek(&f->handle, (FSIZE_t)offset) != FR_OK ||
      f_read(&f->handle, buffer, (UINT)size, &taken) != FR_OK) {
    f_close(&f->handle);
    f->is_open = 0;
    return -1;
  }
  return (int32_t)taken;
}

static void write_card(FATFS* volume) {
  static uint8_t work[4096];
  FIL out;
  UINT written = 0;
  require(f_mkfs("", NULL, work, sizeof work) == FR_OK, "f_mkfs");
  require(f_mount(volume, "", 1) == FR_OK, "f_mount");
  require(f_open(&out, "AREA.MTP", FA_WRITE | FA_CREATE_ALWAYS) == FR_OK, "f_open");
  require(f_write(&out, pack_bytes, (UINT)pack_size, &written) == FR_OK && written == pack_size &&
              f_close(&out) == FR_OK,
          "f_write");
}

int main(int argc, char** argv) {
  static FATFS volume;
  static file f;
  microtin_pack* pack;
  uint32_t hint = 0, io = 0;
  int i;
  require(argc == 2, "fatfs PACK");
  find_places(argv[1]);
  write_card(&volume);
  pack = new_pack(4);
  microtin_pack_align_reads(pack, 512);
  fails = 1;
  for (i = 0; i < PLACES; ++i) {
    const place* const p = places + i;
    const microtin_segment here = {p->x, p->y, p->x, p->y};
    int32_t height = 0;
    microtin_status status;
    while ((status = microtin_pack_load_with(pack, &here, read_file, &f, 50)) !=
           MICROTIN_STATUS_OK) {
      if (status == MICROTIN_STATUS_IO) ++io;
      require(status == MICROTIN_STATUS_IO || status == MICROTIN_STATUS_NEED_INPUT ||
                  status == MICROTIN_STATUS_STEP_LIMIT,
              "a status of loading");
    }
    require(microtin_pack_height_at(pack, p->x, p->y, &hint, &height) == MICROTIN_QUERY_OK &&
                height == p->height,
            "a height");
  }
  require(io != 0 && f.opened > 1, "no read failed");
  printf("FatFs: %d of %d heights right, failed reads: %lu, opened: %lu times\n", i, PLACES,
         (unsigned long)failures, (unsigned long)f.opened);
  return 0;
}
