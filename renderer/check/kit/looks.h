// SPDX-License-Identifier: Apache-2.0
// look: which surface each pixel of a picture shows, where, and whether light reaches it there.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/measure/reference.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight::check {

struct Seen {
  uint64_t id = kNothingHit;  // as surface_id
  Vec3 at{0.0};               // scene units
  bool is_lit = false;        // some light reaches it
  uint32_t body() const { return static_cast<uint32_t>(id >> 32); }
};

// One sample a pixel of the picture, or of a part of it, row by row, by the renderer's own kernel without recursion.
std::vector<Seen> look(std::string_view json, TilePool& pool, std::optional<TileRect> part = std::nullopt);

}  // namespace tilelight::check
