// SPDX-License-Identifier: MIT
// Metadata with each note.
#ifndef MICROTIN_TESTS_SUPPORT_NOTED_METADATA_HPP
#define MICROTIN_TESTS_SUPPORT_NOTED_METADATA_HPP

#include "encoder/terrain/metadata.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {

// Golden files have these: digest and phases are those of notes.mtin.
inline Metadata noted_metadata() {
  Metadata m = full_metadata();
  m.date = "2019-05/2021";
  m.lineage = "noise removed";
  m.wkt = "LOCAL_CS[\"site\"]";
  m.water_level = Decimal{-35, 1};
  m.true_places = Accuracy{{}, Decimal{51, 2}, Decimal{124, 3}, Decimal{0, 0}};
  m.surface = SurfaceKind::kTop;
  m.side = BoundSide::kNeverBelow;
  m.at_samples = Distances{{0, 0}, {99, 1}};
  m.classes = ClassSet().set(2).set(8).set(9);
  m.duplicates = DuplicateRule::kHighest;
  m.attribution = "\xC2\xA9 the <survey>\x1B";
  m.license = "CC-BY-4.0";
  m.valid = "2024-01/..";
  m.epoch = Decimal{20205, 1};
  m.source_accuracy = SourceAccuracy{AccuracyKind::kLe90, {4, 0}};
  m.digest = 0x7A9C47CC04D5A7B5;
  m.phases = {{60, 219, Decimal{99, 1}}};
  m.places = {{PlaceKind::kOverview, PlaceBase::kEnd, 300, 200},
              {PlaceKind::kGeoid, PlaceBase::kStart, 4096, 1000}};
  return m;
}

}  // namespace microtin::tests

#endif
