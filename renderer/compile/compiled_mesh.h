// SPDX-License-Identifier: Apache-2.0
// compile_mesh: TriMesh -> CompiledMesh: normalised, indexed. Pure; shared by all instances.
#pragma once

#include <memory>

#include "renderer/compile/compiled_scene.h"

namespace tilelight {

std::shared_ptr<const CompiledMesh> compile_mesh(const TriMesh& mesh);

}  // namespace tilelight
