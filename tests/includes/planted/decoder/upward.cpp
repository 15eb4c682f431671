// Includes the encoder.
#include "encoder/exact/wide.hpp"
