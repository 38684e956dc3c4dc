// SPDX-License-Identifier: Apache-2.0
// check_document: holds a document against the grammar.
#pragma once

#include "renderer/scene/document.h"
#include "renderer/scene/grammar.h"
#include "renderer/scene/problems.h"

namespace tilelight {

// Reports whatever the grammar refuses, and marks it rejected so that readers pass it by.
void check_document(Value root, const Record& grammar, Problems& problems);

// Reports every name that stands more than once in one object.
void report_duplicates(Document& document, Problems& problems);

}  // namespace tilelight
