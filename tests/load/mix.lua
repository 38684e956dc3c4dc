-- SPDX-License-Identifier: Apache-2.0
-- What wrk sends, on one thread: four small scenes in turn, `-- KIND FIRST_SEED`. With the kind "distinct" no two requests
-- ask for the same picture (the seed of the sampling differs), so that nothing can be shared; with "identical" only four
-- pictures are asked for.
local scenes = {
  -- a mirror and a matt sphere on a checkered plane
  [[{"image": {"width": 160, "height": 90}, "render": {"samples": 1, "seed": SEED},
     "materials": {"mirror": {"diffuse": 0.1, "specular": 0.6, "reflection": 0.8},
                   "floor": {"diffuse": {"checker": {"a": 0.85, "b": 0.2, "size": 1}}}},
     "objects": [{"type": "plane", "material": "floor"},
                 {"type": "sphere", "center": [0, 1, 0], "radius": 1, "material": "mirror"},
                 {"type": "sphere", "center": [1.8, 0.5, 0.8], "radius": 0.5}]}]],
  -- a glass sphere before three boxes
  [[{"image": {"width": 160, "height": 90}, "render": {"samples": 1, "seed": SEED},
     "materials": {"glass": {"diffuse": 0, "specular": 0.5, "reflection": 1, "transmission": 1, "fresnel": true}},
     "objects": [{"type": "plane"}, {"type": "sphere", "center": [0, 1, 2], "radius": 1, "material": "glass"},
                 {"type": "box", "min": [-2, 0, -1], "max": [-1, 1, 0]},
                 {"type": "box", "min": [-0.5, 0, -1], "max": [0.5, 2, 0]},
                 {"type": "box", "min": [1, 0, -1], "max": [2, 3, 0]}]}]],
  -- one chess piece
  [[{"image": {"width": 160, "height": 90}, "render": {"samples": 1, "seed": SEED},
     "objects": [{"type": "chess_piece", "piece": "knight", "detail": 24}]}]],
  -- an endgame
  [[{"image": {"width": 160, "height": 90}, "render": {"samples": 1, "seed": SEED},
     "objects": [{"type": "chess_position", "fen": "8/8/8/4k3/8/8/4P3/4K3", "detail": 16}]}]],
}

local worker

function setup(thread)
  worker = thread
end

function init(args)
  step = args[1] == "distinct" and 1 or 0
  first_seed = tonumber(args[2])
  sent = 0
  statuses = {}
end

function request()
  local seed = string.format("%d", (first_seed + step * sent) % 4294967296)
  local scene = scenes[sent % #scenes + 1]:gsub("SEED", seed)
  sent = sent + 1
  return wrk.format("POST", "/v1/renders", {["Content-Type"] = "application/json", ["Accept"] = "image/png",
                                            ["Prefer"] = "wait=60"}, scene)
end

function response(status)
  statuses[status] = (statuses[status] or 0) + 1
end

function done(summary, latency)
  local parts = {}
  for status, count in pairs(worker:get("statuses")) do
    table.insert(parts, string.format('"%d": %d', status, count))
  end
  local errors = summary.errors
  io.write(string.format(
    '\nRESULT {"seconds": %.6f, "requests": %d, "p50_ms": %.3f, "p99_ms": %.3f, "max_ms": %.3f, "socket_errors": %d, ' ..
    '"timeouts": %d, "statuses": {%s}}\n',
    summary.duration / 1e6, summary.requests, latency:percentile(50) / 1e3, latency:percentile(99) / 1e3,
    latency.max / 1e3, errors.connect + errors.read + errors.write, errors.timeout, table.concat(parts, ", ")))
end
