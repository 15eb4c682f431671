// SPDX-License-Identifier: MIT
// Includes what comes after its subject.
#include "encoder/import/import.hpp"
