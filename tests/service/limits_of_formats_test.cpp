// SPDX-License-Identifier: Apache-2.0
// What a format of pictures cannot hold: values and sides.
#include <algorithm>
#include <cmath>

#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

class FormatLimits : public ServiceTest {};

// A matt sphere under its default light times `intensity`.
std::string lit_scene(const std::string& intensity, const std::string& exposure = "0") {
  return R"({"image": {"width": 16, "height": 16, "exposure": )" + exposure +
         R"(}, "render": {"samples": 4}, "lights": [{"type": "point", "position": [3, 4, 5], "intensity": )" +
         intensity + R"(}], "objects": [{"type": "sphere", "material": {"specular": 0}}]})";
}

Image exr_of(const Service& service, const std::string& scene) {
  const HttpAnswer answer = service.post("/v1/renders", scene, {{"Accept", "image/x-exr"}});
  EXPECT_EQ(answer.status, 200) << answer.body;
  const auto image = decode_linear(answer.body, ImageFormat::exr, 1 << 20);
  EXPECT_TRUE(image) << image.error().detail;
  return image ? *image : Image{};
}

TEST_F(FormatLimits, AnExrHoldsValuesThatNoHalfFloatDoes) {
  const Image once = exr_of(*service_, lit_scene("1")), brighter = exr_of(*service_, lit_scene("16777216")),
              darker = exr_of(*service_, lit_scene("5.9604644775390625e-8"));
  ASSERT_EQ(once.rgb.size(), 3u * 16 * 16);
  EXPECT_GT(*std::max_element(brighter.rgb.begin(), brighter.rgb.end()), 65504.0f * 10);
  int moved = 0;
  for (size_t i = 0; i < once.rgb.size(); ++i) {
    // Light is linear, and powers of two are exact; the background and ambient light stay.
    if (brighter.rgb[i] == once.rgb[i]) continue;
    ++moved;
    EXPECT_TRUE(std::isfinite(brighter.rgb[i])) << i;
    EXPECT_GT(brighter.rgb[i] / once.rgb[i], 1e4f) << i;
    EXPECT_GT(darker.rgb[i], 0.0f) << i;
  }
  EXPECT_GT(moved, 100);
}

TEST_F(FormatLimits, ExposureBeyondAFloatIsClampedAndCountedAndSharesNoCountWithAPng) {
  const std::string scene = lit_scene("1", "200");
  const HttpAnswer exr = service_->post("/v1/renders", scene, {{"Accept", "image/x-exr"}});
  const auto image = decode_linear(exr.body, ImageFormat::exr, 1 << 20);
  ASSERT_TRUE(image);
  const auto most = std::count(image->rgb.begin(), image->rgb.end(), std::numeric_limits<float>::max());
  EXPECT_GT(most, 100);
  EXPECT_TRUE(std::all_of(image->rgb.begin(), image->rgb.end(), [](float v) { return std::isfinite(v); }));
  EXPECT_NE(exr.header("render-info").find(", clamped=" + std::to_string(most)), std::string::npos)
      << exr.header("render-info");
  const HttpAnswer png = service_->post("/v1/renders", scene, {{"Accept", "image/png"}});
  EXPECT_EQ(png.header("render-info").find("clamped"), std::string::npos) << "over white is white there";
}

TEST_F(FormatLimits, TheErrorByPixelOfAnExrIsFinite) {
  const std::string job = service_->post("/v1/renders", lit_scene("1e30", "100")).header("location");
  EXPECT_EQ(service_->wait_for_end(job).at("state"), "done");
  const HttpAnswer error = service_->get(job + "/image?layer=error", {{"Accept", "image/x-exr"}});
  const auto image = decode_linear(error.body, ImageFormat::exr, 1 << 20);
  ASSERT_TRUE(image) << error.body;
  EXPECT_TRUE(std::all_of(image->rgb.begin(), image->rgb.end(), [](float v) { return std::isfinite(v) && v >= 0.0f; }));
}

TEST_F(FormatLimits, ArePublishedAndTheLimitOfASceneCountsToo) {
  server::Config config;
  config.limits.image_side = 1000;
  const Json limits = Json::parse(Service(config).get("/v1/limits").body);
  for (const char* format : {"png", "jpeg", "exr", "svg"}) EXPECT_EQ(limits["formats"][format]["image_side"], 1000);
}

}  // namespace
}  // namespace tilelight::service
