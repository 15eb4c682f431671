// SPDX-License-Identifier: MIT
/* A pack on a card whose file system never waits, such as AsyncFatFs, or one that reads by DMA. A
 * state machine opens the file, seeks and reads, a step at a time. The card may be pulled out and
 * put back, and another user may have the bus. decoder/docs/autopilots.md has a drawing.
 *
 * Not part of the library. */
#ifndef MICROTIN_ADAPTERS_CARD_H
#define MICROTIN_ADAPTERS_CARD_H

#include "spots.h"

/* Steps for which opening, seeking or reading may last before it counts as failed. */
#ifndef MICROTIN_CARD_PATIENCE
#define MICROTIN_CARD_PATIENCE 1000
#endif

/* Steps after a failure before the file is opened again. */
#ifndef MICROTIN_CARD_REST
#define MICROTIN_CARD_REST 50
#endif

typedef enum microtin_card_presence {
  MICROTIN_CARD_READY,
  MICROTIN_CARD_BUSY,  /* another user, such as the blackbox, has the bus */
  MICROTIN_CARD_ABSENT /* no card, or its file system is not mounted */
} microtin_card_presence;

typedef enum microtin_card_progress {
  MICROTIN_CARD_DONE,
  MICROTIN_CARD_NOT_YET, /* call again */
  MICROTIN_CARD_FAILED
} microtin_card_progress;

/* Your functions, none of which waits. */
typedef struct microtin_card_driver {
  microtin_card_presence (*presence)(void* context);
  /* Begins to open the pack's file, or continues it. */
  microtin_card_progress (*open)(void* context);
  /* Begins to seek, or continues it with the same offset. */
  microtin_card_progress (*seek)(void* context, uint64_t offset);
  /* Begins to read, or continues it with the same arguments. Returns as a microtin_read does:
   * MICROTIN_READ_NOT_READY until bytes are there, 0 at the end of the file. */
  int32_t (*read)(void* context, uint8_t* buffer, size_t size);
  /* Closes the file if it is open, and ends what is in progress: DMA must not write any more. Also
   * called after a failure and when the card is gone. */
  void (*close)(void* context);
} microtin_card_driver;

typedef enum microtin_card_state {
  MICROTIN_CARD_GONE,
  MICROTIN_CARD_CLOSED,
  MICROTIN_CARD_OPENING,
  MICROTIN_CARD_OPEN,
  MICROTIN_CARD_SEEKING,
  MICROTIN_CARD_READING
} microtin_card_state;

typedef struct microtin_card {
  const microtin_card_driver* driver;
  void* context;
  uint64_t at; /* where the file is */
  uint64_t target;
  uint16_t waited, rest; /* steps */
  uint16_t removals;     /* how often the card went: compare it to see whether to reset the pack */
  uint8_t state;         /* a microtin_card_state */
} microtin_card;

static inline void microtin_card_init(microtin_card* card, const microtin_card_driver* driver,
                                      void* context) {
  card->driver = driver;
  card->context = context;
  card->at = 0;
  card->target = 0;
  card->waited = 0;
  card->rest = 0;
  card->removals = 0;
  card->state = MICROTIN_CARD_CLOSED;
}

static inline void microtin_card_enter(microtin_card* card, microtin_card_state state) {
  card->state = (uint8_t)state;
  card->waited = 0;
}

/* Reports a failure to the pack, which requests the same bytes again. */
static inline void microtin_card_fail(microtin_card* card, microtin_pack* pack,
                                      microtin_card_state state) {
  if (card->state > MICROTIN_CARD_CLOSED) card->driver->close(card->context);
  microtin_card_enter(card, state);
  card->rest = MICROTIN_CARD_REST;
  microtin_pack_complete_read(pack, -1);
}

/* What follows from opening or seeking. */
static inline void microtin_card_progressed(microtin_card* card, microtin_pack* pack,
                                            microtin_card_progress progress) {
  if (progress == MICROTIN_CARD_DONE) {
    card->at = card->state == MICROTIN_CARD_SEEKING ? card->target : 0;
    microtin_card_enter(card, MICROTIN_CARD_OPEN);
  } else if (progress == MICROTIN_CARD_FAILED || ++card->waited > MICROTIN_CARD_PATIENCE) {
    microtin_card_fail(card, pack, MICROTIN_CARD_CLOSED);
  }
}

static inline void microtin_card_read(microtin_card* card, microtin_pack* pack, uint8_t* buffer,
                                      size_t size) {
  const int32_t taken = card->driver->read(card->context, buffer, size);
  if (taken == MICROTIN_READ_NOT_READY) {
    if (++card->waited > MICROTIN_CARD_PATIENCE)
      microtin_card_fail(card, pack, MICROTIN_CARD_CLOSED);
  } else if (taken < 0) {
    microtin_card_fail(card, pack, MICROTIN_CARD_CLOSED);
  } else {
    microtin_pack_complete_read(pack, taken);
    card->at += (uint64_t)taken;
    microtin_card_enter(card, MICROTIN_CARD_OPEN);
  }
}

/* A step towards the bytes that the pack needs, with at most one call of open, seek or read. 1:
 * call microtin_pack_load now; 0: a read into the pack's buffer is in progress, so do not. */
static inline int microtin_card_step(microtin_card* card, microtin_pack* pack) {
  const microtin_card_presence presence = card->driver->presence(card->context);
  uint64_t offset;
  uint8_t* buffer;
  size_t size;
  if (presence == MICROTIN_CARD_ABSENT) {
    if (card->state != MICROTIN_CARD_GONE) ++card->removals;
    microtin_card_fail(card, pack, MICROTIN_CARD_GONE);
    return 1;
  }
  if (presence == MICROTIN_CARD_BUSY) return card->state != MICROTIN_CARD_READING;
  if (card->state == MICROTIN_CARD_GONE) {
    microtin_card_enter(card, MICROTIN_CARD_CLOSED);
    card->rest = 0;
  }
  microtin_pack_next_read(pack, &offset, &buffer, &size);
  if (card->state == MICROTIN_CARD_CLOSED) {
    if (card->rest != 0) --card->rest;
    if (card->rest != 0 || size == 0) return 1;
    microtin_card_enter(card, MICROTIN_CARD_OPENING);
  } else if (card->state == MICROTIN_CARD_OPEN) {
    if (size == 0) return 1;
    card->target = offset;
    microtin_card_enter(card, card->at == offset ? MICROTIN_CARD_READING : MICROTIN_CARD_SEEKING);
  }
  if (card->state == MICROTIN_CARD_OPENING) {
    microtin_card_progressed(card, pack, card->driver->open(card->context));
  } else if (card->state == MICROTIN_CARD_SEEKING) {
    microtin_card_progressed(card, pack, card->driver->seek(card->context, card->target));
  } else {
    microtin_card_read(card, pack, buffer, size);
  }
  return card->state != MICROTIN_CARD_READING;
}

/* One service of the adapters' requests from such a card, for microtin_spots_load. Statuses are
 * those of microtin_requests_load: IO while the card is gone or fails, NEED_INPUT while bytes are
 * not there yet. */
static inline microtin_status microtin_spots_load_card(microtin_spots* s, microtin_card* card,
                                                       uint32_t step_limit) {
  microtin_segment segment;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  if (!microtin_card_step(card, s->pack)) return status;
  status = microtin_requests_next(&s->requests, &segment);
  if (status == MICROTIN_STATUS_NEED_INPUT) {
    status = microtin_requests_note(&s->requests,
                                    MICROTIN_SPOTS_PACK_LOAD(s->pack, &segment, step_limit));
  }
  microtin_spots_note_header(s);
  return status;
}

#endif
