// SPDX-License-Identifier: Apache-2.0
// The renderer's public door: parse a scene, compile it, plan a view, render it, encode the image.
//
//   TilePool pool;
//   auto parsed = parse_scene(json, Limits{});                       // or every error at once
//   auto scene  = compile_scene(parsed->scene, pool);                // immutable, shared by all views
//   auto render = Render::start(pool, Priority::normal, scene, plan_view(*scene, parsed->view));
//   render->wait_ms(1e9);
//   auto png    = encode_image(*render->image(), parsed->view.image.exposure, ImageFormat::png);
#pragma once

#include "renderer/base/characters.h"        // IWYU pragma: export
#include "renderer/base/hash.h"              // IWYU pragma: export
#include "renderer/base/result.h"            // IWYU pragma: export
#include "renderer/base/standard_streams.h"  // IWYU pragma: export
#include "renderer/compile/compile.h"        // IWYU pragma: export
#include "renderer/film/film.h"              // IWYU pragma: export
#include "renderer/film/heat_map.h"          // IWYU pragma: export
#include "renderer/film/image_io.h"          // IWYU pragma: export
#include "renderer/measure/rounding.h"       // IWYU pragma: export
#include "renderer/render/explain.h"         // IWYU pragma: export
#include "renderer/render/predict.h"         // IWYU pragma: export
#include "renderer/render/render.h"          // IWYU pragma: export
#include "renderer/scene/parse.h"            // IWYU pragma: export
#include "renderer/scene/spelling.h"         // IWYU pragma: export
#include "renderer/schedule/tile_pool.h"     // IWYU pragma: export
