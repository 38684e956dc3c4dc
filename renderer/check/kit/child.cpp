// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/child.h"

#include <fstream>
#include <iterator>
#include <utility>

namespace tilelight::check {

std::string image_by_command(const std::string& command, std::string_view scene_json,
                             const std::vector<std::string>& environment) {
  const TemporaryFolder folder;
  const std::string image = folder.file("image.exr");
  if (run_child(command, {"render", "-", "-o", image}, scene_json, environment).status != 0) return {};
  std::ifstream in(image, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string rays_by_command(const std::string& command, std::string_view scene_json, int x, int y,
                            const std::vector<std::string>& environment) {
  const std::string pixel = std::to_string(x) + "," + std::to_string(y);
  ChildResult result = run_child(command, {"render", "-", "--pixel", pixel}, scene_json, environment);
  return result.status == 0 ? std::move(result.output) : std::string();
}

}  // namespace tilelight::check
