// SPDX-License-Identifier: MIT
// What all calls of the public interface in C share: exceptions become a status and a message, and
// structs may be of another version.
#ifndef MICROTIN_ENCODER_PRODUCT_C_CALLS_HPP
#define MICROTIN_ENCODER_PRODUCT_C_CALLS_HPP

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/layers.hpp"
#include "microtin/encoder.h"
#include "microtin/encoder.hpp"

namespace microtin::product {

// Keeps the message for microtin_last_error, and returns the outcome.
microtin_status failed(microtin_status outcome, const char* why);

// Runs `work`, whose exceptions nobody in C can catch.
template <class Work>
microtin_status guarded(const Work& work) {
  try {
    work();
    return MICROTIN_STATUS_OK;
  } catch (const encoder::Cancelled& cancelled) {
    return failed(MICROTIN_STATUS_CANCELLED, cancelled.what());
  } catch (const std::bad_alloc&) {
    return failed(MICROTIN_STATUS_NO_MEMORY, "out of memory");
  } catch (const std::out_of_range& refused) {
    return failed(MICROTIN_STATUS_REJECTED, refused.what());
  } catch (const std::runtime_error& refused) {
    return failed(MICROTIN_STATUS_REJECTED, refused.what());
  } catch (const std::exception& fault) {
    return failed(MICROTIN_STATUS_INTERNAL, fault.what());
  }
}

inline std::string text_of(const char* text) {
  return text != nullptr ? text : "";
}

template <class Pointer>
void expect(Pointer* pointer) {
  if (pointer == nullptr) throw Error("a pointer is null");
}

// Structs begin with their size as the caller's version of the header has it. What the caller does
// not know has its default; what the library does not know must be 0.
constexpr size_t kLargestStruct = 4096;  // of any later version; a larger size was never set

template <class Struct>
void expect_struct(const Struct* given) {
  expect(given);
  if (given->size < sizeof given->size || given->size > kLargestStruct) {
    throw Error("the size of a struct is not set: assign its sizeof");
  }
}

template <class Struct>
Struct read_struct(const Struct* given) {
  expect_struct(given);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
  if (given->size < sizeof given->size)
    throw Error("the size of a struct is not set: assign sizeof");
  if (given->size > sizeof(Struct) && std::any_of(bytes + sizeof(Struct), bytes + given->size,
                                                  [](int byte) { return byte != 0; })) {
    throw Error("a struct has members of a later version: link that version of libmicrotin");
  }
  Struct known{};
  std::memcpy(&known, given, std::min(given->size, sizeof(Struct)));
  return known;
}

template <class Struct>
void write_struct(Struct known, Struct* to) {
  known.size = to->size;
  std::memset(to, 0, known.size);
  std::memcpy(to, &known, std::min(known.size, sizeof(Struct)));
}

inline void copy_decimal(const std::string& decimal, char (&to)[24]) {
  std::strncpy(to, decimal.c_str(), sizeof to - 1);  // 21 characters at most
}

}  // namespace microtin::product

#endif
