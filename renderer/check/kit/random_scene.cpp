// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/random_scene.h"

#include "renderer/check/kit/pictures.h"

namespace tilelight::check {
namespace {

bool happens(Random& random, double probability) { return random.unit() < probability; }

std::string color(Random& random, double low, double high) {
  return text(Vec3(random.between(low, high), random.between(low, high), random.between(low, high)));
}

std::string material(Random& random) {
  std::string out = R"({"diffuse": )" + color(random, 0.1, 0.9);
  if (happens(random, 0.6))
    out += R"(, "specular": )" + text(random.between(0.1, 0.8)) + R"(, "shininess": )" + text(random.between(4, 200));
  if (happens(random, 0.35)) out += R"(, "reflection": )" + text(random.between(0.05, 0.7));
  if (happens(random, 0.15)) out += R"(, "transmission": 0.8, "ior": 1.5)";
  return out + "}";
}

std::string object(Random& random) {
  const Vec3 at(random.between(-3, 3), random.between(0.2, 1.5), random.between(-3, 3));
  const std::string look = R"(, "material": )" + material(random) + "}";
  const double kind = random.unit();
  if (kind < 0.4)
    return R"({"type": "sphere", "center": )" + text(at) + R"(, "radius": )" + text(random.between(0.2, 1.2)) + look;
  if (kind < 0.7)
    return R"({"type": "cube", "center": )" + text(at) + R"(, "size": )" + text(random.between(0.3, 1.6)) +
           R"(, "rotate_deg": {"axis": )" + text(random.direction()) + R"(, "angle": )" + text(random.between(0, 90)) +
           "}" + look;
  static constexpr const char* kPieces[] = {"pawn", "rook", "knight", "bishop", "queen", "king"};
  return std::string(R"({"type": "chess_piece", "detail": 16, "piece": ")") + kPieces[random.next() % 6] +
         R"(", "position": )" + text(Vec3(at.x, 0.0, at.z)) + look;
}

}  // namespace

std::string random_scene_json(Random& random, const std::string& image_and_render) {
  std::string objects;
  const int count = 3 + static_cast<int>(random.next() % 7);
  for (int i = 0; i < count; ++i) objects += object(random) + ", ";
  const bool is_checked = happens(random, 0.5);
  objects += std::string(R"({"type": "box", "min": [-5, -0.2, -5], "max": [5, 0, 5], "material": {"diffuse": )") +
             (is_checked ? R"({"checker": {"a": 0.8, "b": 0.15, "size": 0.7}})" : color(random, 0.3, 0.8)) + "}}";
  std::string lights = R"({"type": "point", "position": )" +
                       text(Vec3(random.between(-5, 5), random.between(3, 7), random.between(-5, 5))) +
                       R"(, "intensity": )" + text(random.between(4, 9)) + "}";
  if (happens(random, 0.5))
    lights += R"(, {"type": "directional", "direction": )" +
              text(Vec3(random.between(-1, 1), -1.0, random.between(-1, 1))) + R"(, "intensity": 0.4})";
  return "{" + image_and_render + R"("attenuation": {"mode": "linear", "k": 3}, "lights": [)" + lights +
         R"(], "objects": [)" + objects + "]}";
}

}  // namespace tilelight::check
