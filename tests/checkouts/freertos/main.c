// SPDX-License-Identifier: MIT
/* A task of FreeRTOS loads tiles, and another one queries heights: of higher priority, or, with
 * EQUAL_PRIORITY, of the same one, with the hooks of microtin_config.h. */
#include "FreeRTOS.h"
#include "task.h"
#include "tests/checkouts/expected.h"

#ifdef EQUAL_PRIORITY
#define QUERY_PRIORITY 1

void pack_enter(void) {
  taskENTER_CRITICAL();
}

void pack_leave(void) {
  taskEXIT_CRITICAL();
}
#else
#define QUERY_PRIORITY 2
#endif

static microtin_pack* pack;
static microtin_segment wanted; /* under taskENTER_CRITICAL */

static void load_tiles(void* unused) {
  (void)unused;
  for (;;) {
    microtin_segment segment;
    taskENTER_CRITICAL();
    segment = wanted;
    taskEXIT_CRITICAL();
    switch (microtin_pack_load_with(pack, &segment, read_memory, NULL, 50)) {
      case MICROTIN_STATUS_OK:
        vTaskDelay(1);
        break;
      case MICROTIN_STATUS_NEED_INPUT:
      case MICROTIN_STATUS_STEP_LIMIT:
        break;
      default:
        require(0, "a status of loading");
    }
  }
}

static void query_heights(void* unused) {
  uint32_t hint = 0, early = 0;
  int i;
  (void)unused;
  for (i = 0; i < PLACES; ++i) {
    const place* const p = places + i;
    const microtin_segment here = {p->x, p->y, p->x, p->y};
    int32_t height = 0;
    taskENTER_CRITICAL();
    wanted = here;
    taskEXIT_CRITICAL();
    while (microtin_pack_height_at(pack, p->x, p->y, &hint, &height) != MICROTIN_QUERY_OK) {
      ++early;
      if (QUERY_PRIORITY > 1) vTaskDelay(1);
    }
    require(height == p->height, "a height");
  }
  printf("FreeRTOS, %s priority: %d of %d heights right, queries before their tile: %lu\n",
         QUERY_PRIORITY > 1 ? "higher" : "equal", i, PLACES, (unsigned long)early);
  exit(0);
}

int main(int argc, char** argv) {
  require(argc == 2, "main PACK");
  find_places(argv[1]);
  pack = new_pack(2);
  xTaskCreate(load_tiles, "load", configMINIMAL_STACK_SIZE, NULL, 1, NULL);
  xTaskCreate(query_heights, "query", configMINIMAL_STACK_SIZE, NULL, QUERY_PRIORITY, NULL);
  vTaskStartScheduler();
  return 1;
}
