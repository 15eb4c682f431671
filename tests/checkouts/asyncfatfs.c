// SPDX-License-Identifier: MIT
/* A pack on a card with AsyncFatFs, read by decoder/adapters/card.h. A sector takes several polls,
 * so that nearly all calls answer "not yet". The image is an empty volume with FAT16. */
#include "asyncfatfs.h"

#include "decoder/adapters/card.h"
#include "sdcard.h"
#include "tests/checkouts/expected.h"

/* --- The card: one operation at a time, done after some polls. --- */

static uint8_t* image;
static size_t image_size;

static struct {
  uint32_t polls_left, block;
  uint8_t* buffer;
  sdcard_operationCompleteCallback_c done;
  uint32_t data;
  int writes;
} operation;

static int start_operation(uint32_t block, uint8_t* buffer, int writes,
                           sdcard_operationCompleteCallback_c done, uint32_t data) {
  if (operation.polls_left != 0) return 0;
  require(((size_t)block + 1) * 512 <= image_size, "a block of the card");
  operation.polls_left = 4;
  operation.block = block;
  operation.buffer = buffer;
  operation.writes = writes;
  operation.done = done;
  operation.data = data;
  return 1;
}

bool sdcard_readBlock(uint32_t block, uint8_t* buffer, sdcard_operationCompleteCallback_c done,
                      uint32_t data) {
  return start_operation(block, buffer, 0, done, data);
}

sdcardOperationStatus_e sdcard_writeBlock(uint32_t block, uint8_t* buffer,
                                          sdcard_operationCompleteCallback_c done, uint32_t data) {
  return start_operation(block, buffer, 1, done, data) ? SDCARD_OPERATION_IN_PROGRESS
                                                       : SDCARD_OPERATION_BUSY;
}

sdcardOperationStatus_e sdcard_beginWriteBlocks(uint32_t block, uint32_t count) {
  (void)block;
  (void)count;
  return SDCARD_OPERATION_SUCCESS;
}

sdcardOperationStatus_e sdcard_endWriteBlocks(void) {
  return SDCARD_OPERATION_SUCCESS;
}

void sdcard_setProfilerCallback(sdcard_profilerCallback_c callback) {
  (void)callback;
}

bool sdcard_poll(void) {
  uint8_t* const on_card = image + (size_t)operation.block * 512;
  if (operation.polls_left == 0) return true;
  if (--operation.polls_left != 0) return false;
  if (operation.writes) {
    memcpy(on_card, operation.buffer, 512);
  } else {
    memcpy(operation.buffer, on_card, 512);
  }
  if (operation.done) {
    operation.done(operation.writes ? SDCARD_BLOCK_OPERATION_WRITE : SDCARD_BLOCK_OPERATION_READ,
                   operation.block, operation.buffer, operation.data);
  }
  return true;
}

/* --- The driver for card.h, as decoder/docs/autopilots.md describes it. --- */

static afatfsFilePtr_t file;
static int is_opening, is_seeking, is_busy;
static uint32_t not_yet;

static void note_open(afatfsFilePtr_t opened) {
  file = opened;
  is_opening = 0;
}

/* The callback may run before afatfs_fopen returns. */
static void begin_to_open(const char* mode) {
  is_opening = 1;
  if (!afatfs_fopen("AREA.MTP", mode, note_open)) is_opening = 0;
}

static microtin_card_presence presence(void* unused) {
  (void)unused;
  if (afatfs_getFilesystemState() != AFATFS_FILESYSTEM_STATE_READY) return MICROTIN_CARD_ABSENT;
  return is_busy ? MICROTIN_CARD_BUSY : MICROTIN_CARD_READY;
}

static microtin_card_progress open_file(void* unused) {
  (void)unused;
  if (file != NULL) return MICROTIN_CARD_DONE;
  if (!is_opening) begin_to_open("r");
  if (file != NULL) return MICROTIN_CARD_DONE;
  ++not_yet;
  return MICROTIN_CARD_NOT_YET;
}

/* A seek that is in progress goes on in afatfs_poll: another call of afatfs_fseek would fail, and
 * afatfs_ftell fails until the seek is done. */
static microtin_card_progress seek_file(void* unused, uint64_t offset) {
  uint32_t at;
  (void)unused;
  if (is_seeking) {
    if (!afatfs_ftell(file, &at)) {
      ++not_yet;
      return MICROTIN_CARD_NOT_YET;
    }
    is_seeking = 0;
    return at == offset ? MICROTIN_CARD_DONE : MICROTIN_CARD_FAILED;
  }
  switch (afatfs_fseek(file, (int32_t)offset, AFATFS_SEEK_SET)) {
    case AFATFS_OPERATION_SUCCESS:
      return MICROTIN_CARD_DONE;
    case AFATFS_OPERATION_IN_PROGRESS:
      is_seeking = 1;
      ++not_yet;
      return MICROTIN_CARD_NOT_YET;
    default: /* the file is busy */
      ++not_yet;
      return MICROTIN_CARD_NOT_YET;
  }
}

static int32_t read_file(void* unused, uint8_t* buffer, size_t size) {
  const uint32_t taken = afatfs_fread(file, buffer, (uint32_t)size);
  (void)unused;
  if (taken != 0) return (int32_t)taken;
  if (afatfs_feof(file)) return 0;
  ++not_yet;
  return MICROTIN_READ_NOT_READY;
}

static void close_file(void* unused) {
  (void)unused;
  if (file != NULL) afatfs_fclose(file, NULL);
  file = NULL;
  is_seeking = 0;
}

static const microtin_card_driver driver = {presence, open_file, seek_file, read_file, close_file};

static void write_pack(void) {
  size_t written = 0;
  while (afatfs_getFilesystemState() != AFATFS_FILESYSTEM_STATE_READY) afatfs_poll();
  begin_to_open("w");
  while (is_opening) afatfs_poll();
  require(file != NULL, "creating the file");
  while (written < pack_size) {
    written += afatfs_fwrite(file, pack_bytes + written, (uint32_t)(pack_size - written));
    afatfs_poll();
  }
  while (!afatfs_fclose(file, NULL)) afatfs_poll();
  file = NULL;
  while (!afatfs_flush()) afatfs_poll();
}

int main(int argc, char** argv) {
  microtin_card card;
  microtin_requests requests;
  microtin_pack* pack;
  uint32_t hint = 0, step = 0;
  int i;
  require(argc == 3, "asyncfatfs PACK IMAGE");
  find_places(argv[1]);
  image = read_whole_file(argv[2], &image_size);
  afatfs_init();
  write_pack();
  pack = new_pack(4);
  microtin_card_init(&card, &driver, NULL);
  microtin_requests_init(&requests, pack);
  for (i = 0; i < PLACES; ++i) {
    const place* const p = places + i;
    const microtin_segment here = {p->x, p->y, p->x, p->y};
    int32_t height = 0;
    microtin_requests_add(&requests, &here, MICROTIN_PRIORITY_HERE);
    while (microtin_pack_height_at(pack, p->x, p->y, &hint, &height) != MICROTIN_QUERY_OK) {
      microtin_segment segment;
      is_busy = ++step % 7 == 0; /* the blackbox has the bus now and then */
      afatfs_poll();
      if (!microtin_card_step(&card, pack) ||
          microtin_requests_next(&requests, &segment) != MICROTIN_STATUS_NEED_INPUT) {
        continue;
      }
      require(microtin_requests_note(&requests, microtin_pack_load(pack, &segment, 20)) !=
                  MICROTIN_STATUS_IO,
              "a status that looks like a failure");
    }
    require(height == p->height, "a height");
  }
  require(not_yet != 0, "nothing had to wait");
  printf("AsyncFatFs: %d of %d heights right, answers \"not yet\": %lu\n", i, PLACES,
         (unsigned long)not_yet);
  return 0;
}
