// SPDX-License-Identifier: MIT
// What the autopilots' adapters answer over a pack, in text, the same on host and device.
#ifndef MICROTIN_TESTS_FIRMWARE_ADAPTERS_REPORT_HPP
#define MICROTIN_TESTS_FIRMWARE_ADAPTERS_REPORT_HPP

#include "decoder/adapters/ardupilot.h"
#include "decoder/adapters/inav.h"
#include "tests/firmware/report.hpp"

namespace microtin {

class AdaptersReport {
 public:
  AdaptersReport(PutChar put, microtin_pack* pack, microtin_read read, void* context)
      : put_(put), pack_(pack), read_(read), context_(context) {}

  // 0, or what went wrong.
  int run() {
    if (!fly_inav()) return 1;
    microtin_pack_reset(pack_);
    return fly_ardupilot() ? 0 : 2;
  }

 private:
  static constexpr int kPlaces = 60, kMostCalls = 100000;
  static constexpr uint32_t kSteps = 50;

  static microtin_spot place(int i) { return {433050000 + i * 15000, 72050000 + i * 13000}; }

  void say(const char* what, float metres) {
    print(put_, what);
    const float sign = metres < 0 ? -0.5f : 0.5f;
    print(put_, static_cast<int32_t>(metres * 1000.0f + sign));
  }

  // Serves until nothing is wished. False if that takes too long.
  template <class Service>
  static bool serve(const Service& service) {
    for (int calls = 0; calls < kMostCalls; ++calls) {
      const microtin_status status = service();
      if (status == MICROTIN_STATUS_OK) return true;
      if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT &&
          status != MICROTIN_STATUS_WORKSPACE_TOO_SMALL) {
        return false;
      }
    }
    return false;
  }

  bool fly_inav() {
    static microtin_inav inav;
    microtin_inav_init(&inav, pack_);
    const auto service = [&] { return microtin_inav_load(&inav, kSteps, read_, context_); };
    if (!serve(service)) return false;
    int misses = 0;
    for (int i = 0; i < kPlaces; ++i) {
      const microtin_spot at = place(i);
      float height = -1;
      while (!microtin_inav_height(&inav, at.latitude, at.longitude, &height)) {
        ++misses;
        if (height != -1 || !microtin_spots_is_pending(&inav.spots) || !serve(service))
          return false;
      }
      say("height ", height);
      microtin_inav_look look = {0, 0, 0, 0};
      do {
        if (!serve(service)) return false;
        if (!microtin_inav_lookahead(&inav, at.latitude, at.longitude, static_cast<float>(i * 6),
                                     900.0f, 0.05f, 0.2f, &look)) {
          return false;
        }
      } while (look.samples_missed != 0 && microtin_spots_is_pending(&inav.spots));
      say(" needed ", look.climb_needed_m);
      say(" deficit ", look.escape_deficit_m);
      print(put_, " missed ");
      print(put_, uint32_t{look.samples_missed});
      print(put_, "\n");
    }
    return misses > 0;
  }

  bool fly_ardupilot() {
    static microtin_ardupilot terrain;
    microtin_ardupilot_init(&terrain, pack_, 30);
    const auto service = [&] { return microtin_ardupilot_load(&terrain, kSteps, read_, context_); };
    const microtin_spot home = place(10);
    microtin_ardupilot_set_reference(&terrain, home.latitude, home.longitude, 30000, 20.0f);
    if (!serve(service)) return false;
    for (int i = 0; i < kPlaces; i += 5) {
      const microtin_spot at = place(i);
      float plain = 0, corrected = 0;
      do {
        if (!serve(service)) return false;
        microtin_ardupilot_height_amsl(&terrain, at.latitude, at.longitude, &corrected, true);
        microtin_ardupilot_height_amsl(&terrain, at.latitude, at.longitude, &plain, false);
      } while (microtin_spots_is_pending(&terrain.spots) != 0);
      say("amsl ", plain);
      say(" corrected by ", corrected - plain);
      float rise = 0;
      do {
        if (!serve(service)) return false;
        rise = microtin_ardupilot_lookahead(&terrain, at.latitude, at.longitude, 45.0f, 1000.0f,
                                            0.03f);
      } while (microtin_spots_is_pending(&terrain.spots) != 0);
      say(" rise ", rise);
      print(put_, "\n");
    }
    return fill_block(terrain, service);
  }

  template <class Service>
  bool fill_block(microtin_ardupilot& terrain, const Service& service) {
    const microtin_spot corner = place(8);
    microtin_ardupilot_begin_block(&terrain, corner.latitude, corner.longitude, 30);
    uint16_t pending = 0, loaded = 0;
    microtin_ardupilot_statistics(&terrain, &pending, &loaded);
    if (pending != 56 || loaded != 0) return false;
    for (int slices = 0; !microtin_ardupilot_fill_block(&terrain, 1); ++slices) {
      if (slices > 1000 || !serve(service)) return false;
    }
    microtin_ardupilot_statistics(&terrain, &pending, &loaded);
    if (pending != 0 || loaded != 56) return false;
    for (const auto& row : terrain.block.height) {
      for (const int16_t height : row) {
        print(put_, int32_t{height});
        print(put_, " ");
      }
      print(put_, "\n");
    }
    return true;
  }

  PutChar put_;
  microtin_pack* pack_;
  microtin_read read_;
  void* context_;
};

}  // namespace microtin

#endif
