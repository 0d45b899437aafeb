// What answers must say: accepted, or refused with the reason, the field, its row or cylinder.
#pragma once

#include <crankloop/status.hpp>

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "field_names.hpp"

namespace crankloop {

/// How GoogleTest shows an answer.
inline void PrintTo(const Status& status, std::ostream* out) {
  *out << (status.ok() ? "no field" : status.field) << "[" << status.index << "] " << describe(status.reason);
}

/// EXPECT_TRUE(accepted(validate(engine))): a refusal is shown with field, row and reason.
inline testing::AssertionResult accepted(const Status& status) {
  return status.ok() ? testing::AssertionSuccess()
                     : testing::AssertionFailure() << "refused: " << testing::PrintToString(status);
}

namespace support {

/// A number that a field must not take, and what it is refused for.
struct Bad {
  double value;
  Reason reason;
};

inline testing::AssertionResult refuses(const Status& status, Reason reason, const std::string& field, int index = -1) {
  if (!is_field(status.field)) return testing::AssertionFailure() << status.field << " is no field of the library";
  if (status.reason == reason && field == status.field && status.index == index) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "got " << testing::PrintToString(status) << ", want " << field << "[" << index
                                     << "] " << describe(reason);
}

}  // namespace support

}  // namespace crankloop
