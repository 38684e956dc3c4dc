// SPDX-License-Identifier: Apache-2.0
// The rows of inputs_large.cpp.
#pragma once

#include "renderer/check/check.h"

namespace tilelight::check {

Outcome of_large_documents(const Context& context);

}  // namespace tilelight::check
