// SPDX-License-Identifier: Apache-2.0
// Result: a value, or the reason why there is none. For what can fail by input; exceptions are for bugs.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace tilelight {

struct Error {
  std::string code;    // stable, lower_snake_case: for programs
  std::string detail;  // what was found, what is allowed, what to do: for people
};

template <class T>
using Result = ::tl::expected<T, Error>;

inline ::tl::unexpected<Error> fail(std::string code, std::string detail) {
  return ::tl::unexpected<Error>(Error{std::move(code), std::move(detail)});
}

}  // namespace tilelight
