// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/laws.h"

#include <gtest/gtest.h>

namespace tilelight::laws {
namespace {

const std::vector<std::string> kPublic = {"renderer/renderer.h", "renderer/film/film.h"};

Violations of_rooms(const std::string& path, const std::string& include) {
  return broken_room_laws({path, "#include \"" + include + "\"\n"}, kPublic);
}
Violations of_doors(const std::string& path, const std::string& include) {
  return broken_door_laws({path, "#include <" + include + ">\n"});
}
Violations of_maths(const std::string& path, const std::string& code) {
  return broken_maths_law({path, "double f(double x) {\n  " + code + "\n}\n"});
}

void expect_none(const Violations& broken) {
  for (const std::string& line : broken) ADD_FAILURE() << line;
}

class TheHouse : public testing::Test {
 protected:
  const std::vector<SourceFile> files_ = read_sources(TILELIGHT_SOURCE_DIR);
};

TEST_F(TheHouse, IsRead) { EXPECT_GT(files_.size(), 40u); }

TEST_F(TheHouse, IncludesOnlyFromTheLeft) {
  std::vector<std::string> doors;
  for (const SourceFile& file : files_)
    if (file.path == "renderer/renderer.h") doors = public_headers_of(file);
  EXPECT_GT(doors.size(), 5u);
  for (const SourceFile& file : files_) expect_none(broken_room_laws(file, doors));
}

TEST_F(TheHouse, LetsEachLibraryInByOneDoor) {
  for (const SourceFile& file : files_) expect_none(broken_door_laws(file));
}

TEST_F(TheHouse, ComputesTheImageWithItsOwnElementaryFunctions) {
  for (const SourceFile& file : files_) expect_none(broken_maths_law(file));
}

TEST_F(TheHouse, KeepsItsFilesShortAndLicensed) {
  for (const SourceFile& file : files_) expect_none(broken_form_laws(file));
}

TEST(RoomLaw, CatchesAnIncludeFromTheRight) {
  EXPECT_EQ(of_rooms("renderer/base/vec.h", "renderer/scene/scene.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/film/film.h", "renderer/scene/scene.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/scene/scene.h", "renderer/schedule/tile_pool.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/geometry/a.cpp", "renderer/schedule/tile_pool.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/shade/a.cpp", "renderer/film/film.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/trace/a.cpp", "renderer/raster/a.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/render/a.cpp", "renderer/measure/metrics.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/measure/a.cpp", "renderer/check/rows.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/render/a.cpp", "renderer/renderer.h").size(), 1u);
}

TEST(RoomLaw, AllowsWhatStandsToTheLeft) {
  for (auto [from, to] : {std::pair{"renderer/compile/a.cpp", "renderer/schedule/tile_pool.h"},
                          {"renderer/trace/a.cpp", "renderer/base/vec.h"},
                          {"renderer/trace/a.cpp", "renderer/film/film.h"},
                          {"renderer/cli/main.cpp", "renderer/renderer.h"},
                          {"renderer/cli/main.cpp", "renderer/trace/isa.h"},
                          {"renderer/film/tone.cpp", "renderer/film/tone.h"},
                          {"server/http/a.cpp", "server/jobs/job.h"},
                          {"server/scenes/a.cpp", "server/clock.h"},
                          {"server/config_json.cpp", "server/config.h"},
                          {"server/jobs/a.cpp", "renderer/film/film.h"}})
    EXPECT_TRUE(of_rooms(from, to).empty()) << from << " " << to;
}

TEST(RoomLaw, KeepsRendererAndServerApart) {
  EXPECT_EQ(of_rooms("renderer/cli/main.cpp", "server/clock.h").size(), 1u);
  EXPECT_EQ(of_rooms("server/jobs/a.cpp", "renderer/trace/isa.h").size(), 1u);
}

TEST(RoomLaw, CatchesAServerRoomThatLooksToTheRight) {
  EXPECT_EQ(of_rooms("server/jobs/a.cpp", "server/http/message.h").size(), 1u);
  EXPECT_EQ(of_rooms("server/jobs/a.cpp", "server/sessions/session.h").size(), 1u);
  EXPECT_EQ(of_rooms("server/log.cpp", "server/jobs/job.h").size(), 1u);
  EXPECT_EQ(of_rooms("server/http/a.cpp", "server/app.h").size(), 1u);
}

TEST(RoomLaw, KnowsEveryRoomByName) {
  EXPECT_EQ(of_rooms("renderer/annex/a.cpp", "renderer/base/vec.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/film/a.cpp", "../scene/scene.h").size(), 1u);
  EXPECT_EQ(of_rooms("renderer/film/a.cpp", "tone.h").size(), 1u);
}

TEST(DoorLaw, CatchesALibraryThroughAWindow) {
  EXPECT_EQ(of_doors("renderer/trace/render_tile.cpp", "hwy/highway.h").size(), 1u);
  EXPECT_EQ(of_doors("renderer/film/phong_simd.cpp", "hwy/highway.h").size(), 1u);
  EXPECT_EQ(of_doors("renderer/scene/parse.cpp", "nlohmann/json.hpp").size(), 1u);
  EXPECT_EQ(of_doors("server/config_json.h", "nlohmann/json_fwd.hpp").size(), 1u);
  EXPECT_EQ(of_doors("renderer/film/image_io.h", "OpenImageIO/imageio.h").size(), 1u);
  EXPECT_EQ(of_doors("renderer/film/image_io.cpp", "libdeflate.h").size(), 1u);
  EXPECT_EQ(of_doors("renderer/film/image_io.cpp", "jpeglib.h").size(), 1u);
  EXPECT_EQ(of_doors("server/log.cpp", "utf8proc.h").size(), 1u);
  EXPECT_EQ(of_doors("server/app.cpp", "httplib.h").size(), 1u);
  EXPECT_EQ(of_doors("renderer/render/render.cpp", "spdlog/spdlog.h").size(), 1u);
  EXPECT_EQ(of_doors("server/scenes/scene_store.cpp", "sqlite3.h").size(), 1u);
  EXPECT_EQ(of_doors("renderer/scene/parse.cpp", "CLI/CLI.hpp").size(), 1u);
}

TEST(DoorLaw, AllowsEachDoor) {
  EXPECT_TRUE(of_doors("renderer/trace/kernel_local_simd.cpp", "hwy/highway.h").empty());
  EXPECT_TRUE(of_doors("renderer/raster/fill-inl.h", "hwy/highway.h").empty());
  EXPECT_TRUE(of_doors("renderer/scene/read_json.cpp", "nlohmann/json.hpp").empty());
  EXPECT_TRUE(of_doors("renderer/film/image_io.cpp", "OpenImageIO/imageio.h").empty());
  EXPECT_TRUE(of_doors("renderer/film/png.cpp", "libdeflate.h").empty());
  EXPECT_TRUE(of_doors("renderer/film/jpeg.cpp", "jerror.h").empty());
  EXPECT_TRUE(of_doors("server/http/listener.cpp", "httplib.h").empty());
}

TEST(MathsLaw, CatchesEveryFormOfACall) {
  for (const char* code :
       {"return std::sin(x);", "return sin(x);", "return ::pow(x, 2);", "x = 2 * exp (x);", "return std::powf(x, 2);",
        "return (log1p(x));", "if (x) cos(x);", "return glm::pow(x, x);", "m = glm::rotate(m, x, axis);",
        "q = glm::slerp(a, b, x);", "return -acos(x);", "return std::hypot(x, x);", "return std::log10(x);",
        "using namespace elementary;\n  return sinh(x);"})
    EXPECT_EQ(of_maths("renderer/compile/a.cpp", code).size(), 1u) << code;
  EXPECT_EQ(of_maths("renderer/trace/a-inl.h", "\n\n return std::tan(x);")[0].substr(0, 24),
            "renderer/trace/a-inl.h:4");
}

TEST(MathsLaw, AllowsOurOwnAndWhatIsExact) {
  for (const char* code :
       {"return elementary::sin(x);", "return std::sqrt(x);", "return std::floor(x);", "// std::sin(x) has other bits",
        "return text(\"sin(x)\");", "return table.log(x);", "return sinus(x);", "return out->exp(x);", "cosine = x;",
        "using elementary::cos;\n  return cos(x);", "using namespace elementary;\n  return pow(x, x);",
        "return 1'000 * elementary::exp(x) * 1'0.5;", "return my_pow(x);", "/* pow(x, y) */ return x;",
        "return R\"(pow(x))\";", "return hn::Exp(d, x);"})
    expect_none(of_maths("renderer/compile/a.cpp", code));
  expect_none(of_maths("renderer/base/elementary_trig.cpp", "return std::sin(x);"));
  expect_none(of_maths("server/jobs/a.cpp", "return std::exp(x);"));
}

TEST(FormLaw, CatchesAMissingLicenceAndALongFile) {
  EXPECT_EQ(broken_form_laws({"renderer/base/a.h", "#pragma once\n"}).size(), 1u);
  const std::string licence = "// SPDX-License-Identifier: Apache-2.0\n";
  EXPECT_TRUE(broken_form_laws({"renderer/base/a.h", licence + std::string(599, '\n')}).empty());
  EXPECT_EQ(broken_form_laws({"renderer/base/a.h", licence + std::string(600, '\n')}).size(), 1u);
}

}  // namespace
}  // namespace tilelight::laws
