// SPDX-License-Identifier: Apache-2.0
// The scenes of the benchmarks: the start position on a table, of meshes alone, so that any tracer can be given it.
#pragma once

#include <string>

namespace tilelight::bench {

// The document: two lights, every surface a mirror of 0.3. detail: of the pieces.
std::string bench_scene(int detail);

// Of 's', 'm' and 'l': about 63,000, 670,000 and 6.6 million triangles.
int detail_of(char size);

}  // namespace tilelight::bench
