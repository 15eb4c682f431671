// SPDX-License-Identifier: MIT
/* What the test needs of FreeRTOS on a host. */
#ifndef MICROTIN_TESTS_CHECKOUTS_FREERTOS_CONFIG_H
#define MICROTIN_TESTS_CHECKOUTS_FREERTOS_CONFIG_H

#include <assert.h>
#include <limits.h>

#define configUSE_PREEMPTION 1
#define configUSE_TIME_SLICING 1
#define configUSE_IDLE_HOOK 0
#define configUSE_TICK_HOOK 0
#define configUSE_16_BIT_TICKS 0
#define configTICK_RATE_HZ 1000
#define configMAX_PRIORITIES 4
#define configMINIMAL_STACK_SIZE PTHREAD_STACK_MIN
#define configTOTAL_HEAP_SIZE (4 << 20)
#define configCHECK_FOR_STACK_OVERFLOW 0
#define configASSERT(condition) assert(condition)
#define INCLUDE_vTaskDelay 1

#endif
