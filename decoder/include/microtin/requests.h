// SPDX-License-Identifier: MIT
/* Requests of a pack: places and segments that compete for its slots. C99 and C++.
 *
 * A vehicle needs the terrain below it, the terrain ahead, and now and then some other place. These
 * requests remember what is needed, and decide which tile is loaded next and which tile gives way:
 *
 * - The own place comes first, the segment ahead next, all other places in turn.
 * - A request never displaces a tile that serves a request before it.
 * - A tile that queries use counts as serving another place, for as long as they use it.
 * - Other places take turns if there is no room for their tiles: at most once in
 *   MICROTIN_REQUEST_TURN services a tile in use gives way to another one.
 * - A place that will be queried soon is loaded when nothing else is missing, into a slot that
 *   serves no request.
 *
 * Interrupts: microtin_requests_add may interrupt microtin_requests_load at any moment, as queries
 * may (pack.h), but not itself. Other loading calls and path searches may take turns with it: each
 * of them first finishes the tile that another one began, unless a more important request needs
 * another tile. Nothing here allocates or waits. */
#ifndef MICROTIN_REQUESTS_H
#define MICROTIN_REQUESTS_H

#include "microtin/compact_pack.h"

/* How many requests there are at most. */
#define MICROTIN_MAX_REQUESTS 8

/* Services (calls of microtin_requests_load) after which an other place that nobody requested again
 * is forgotten. */
#define MICROTIN_REQUEST_LIFE 250

/* Services between two turns, and thus the most that the tile of an other place stays while
 * another one waits for its slot. */
#define MICROTIN_REQUEST_TURN 500

#ifdef __cplusplus
extern "C" {
#endif

/* What a request is for: the most important first. */
typedef enum microtin_priority {
  MICROTIN_PRIORITY_HERE,  /* the own place; the pack keeps one */
  MICROTIN_PRIORITY_AHEAD, /* where the vehicle goes; the pack keeps one */
  MICROTIN_PRIORITY_OTHER, /* every other place; MICROTIN_MAX_REQUESTS - 2 of them */
  MICROTIN_PRIORITY_SOON   /* a place that will be an other one; gives way to these */
} microtin_priority;

/* A request: the requests' own. */
typedef struct microtin_request {
  microtin_segment segment;
  volatile uint8_t is_set;
  volatile uint8_t version;  /* changes with the segment */
  uint8_t served;            /* the version of which all was loaded */
  volatile uint8_t age;      /* services since it was requested last */
  uint8_t rest;              /* services until what could not be loaded is tried again */
  volatile uint8_t priority; /* of requests behind the first two: OTHER or SOON */
  uint16_t waits;            /* services since it was requested first */
} microtin_request;

/* The requests of a pack. All members are the requests' own. */
typedef struct microtin_requests {
  microtin_pack* pack;
  uint16_t since_turn; /* services */
  uint16_t lot;        /* for requests that find no room */
  uint8_t loading;     /* number of the request in hand */
  uint8_t giving_way;  /* number of the slot that gives way to it; 255: none */
  volatile uint8_t was_full;
  microtin_request request[MICROTIN_MAX_REQUESTS]; /* here, ahead, others */
} microtin_requests;

/* Begins without requests for a pack of either kind. After microtin_pack_reset call it again. */
void microtin_requests_init(microtin_requests* requests, microtin_pack* pack);

/* Requests the tiles that a segment touches. HERE and AHEAD replace the request of that priority.
 * An OTHER one replaces one that begins in the same tile; if there is no room, it is dropped, so
 * request again what is still missing. A SOON one never replaces an OTHER one, and is dropped if no
 * slot is free for it. `priority` is a microtin_priority. O(MICROTIN_MAX_REQUESTS).
 *
 * - OK
 * - ARGUMENT: a null pointer, no priority, or a segment that is too long
 * - NEED_INPUT: an OTHER or SOON place before the header is loaded; it is dropped
 * - TOO_BIG: there is no room for another OTHER or SOON place */
microtin_status microtin_requests_add(microtin_requests* requests, const microtin_segment* segment,
                                      uint32_t priority);

/* Returns how many requests are not loaded, as the last service found them; 1 if the header is not
 * loaded. SOON requests do not count: services without pending requests load them. */
uint32_t microtin_requests_pending(const microtin_requests* requests);

/* Returns how many slots the requests need at the same time: tiles that are loaded and in use, and
 * tiles that are missing, without those of SOON requests. More than the pack has slots: some places
 * take turns. Counts up to 32 missing tiles. Call it where microtin_requests_load is called. */
uint32_t microtin_requests_working_set(const microtin_requests* requests);

/* Chooses which segment to load now; microtin_requests_load calls it once for each service.
 *
 * - NEED_INPUT: load *segment
 * - OK: all requests are loaded
 * - WORKSPACE_TOO_SMALL: what is missing waits for a slot */
microtin_status microtin_requests_next(microtin_requests* requests, microtin_segment* segment);

/* Notes what loading the segment returned, and returns the status of the service. */
microtin_status microtin_requests_note(microtin_requests* requests, microtin_status status);

/* One service: loads a piece of what is requested, with `step_limit` work units or less (1 or more)
 * and at most one read.
 *
 * - OK: all requests are loaded, but for bad tiles
 * - NEED_INPUT, STEP_LIMIT: call again
 * - WORKSPACE_TOO_SMALL: the rest waits for a slot: see microtin_requests_working_set
 * - IO and the statuses of a bad header: as microtin_pack_load
 * - WRONG_PACK_KIND: a pack of compact_pack.h
 *
 * Besides what microtin_pack_load takes, a service takes O(slots * tiles of the segments ahead). */
static inline microtin_status microtin_requests_load(microtin_requests* requests,
                                                     microtin_read read, void* context,
                                                     uint32_t step_limit) {
  microtin_segment segment;
  const microtin_status status = microtin_requests_next(requests, &segment);
  if (status != MICROTIN_STATUS_NEED_INPUT) return status;
  return microtin_requests_note(
      requests, microtin_pack_load_with(requests->pack, &segment, read, context, step_limit));
}

/* One service of a pack of compact_pack.h, as microtin_requests_load. */
static inline microtin_status microtin_requests_load_compact(microtin_requests* requests,
                                                             microtin_read read, void* context,
                                                             uint32_t step_limit) {
  microtin_segment segment;
  const microtin_status status = microtin_requests_next(requests, &segment);
  if (status != MICROTIN_STATUS_NEED_INPUT) return status;
  return microtin_requests_note(requests, microtin_compact_pack_load_with(
                                              requests->pack, &segment, read, context, step_limit));
}

#ifdef __cplusplus
}
#endif

#endif
