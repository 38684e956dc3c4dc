// SPDX-License-Identifier: Apache-2.0
// The `tilelight` command from outside: exit codes, messages, files. TILELIGHT_COMMAND is the built program.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "renderer/base/child_process.h"

namespace tilelight {
namespace {

namespace fs = std::filesystem;

constexpr char kScene[] = R"({
  "tilelight": 1,
  "image": {"width": 70, "height": 50},
  "objects": [
    {"type": "sphere", "center": [0, 1, 0], "material": {"diffuse": [0.9, 0.2, 0.1], "specular": 0.5, "reflection": 0.3}},
    {"type": "plane"}
  ]
})";

struct Outcome {
  int code = -1;  // 128 + signal, if one killed it
  std::string out, err;
};

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Command : public testing::Test {
 protected:
  Command() { write("scene.json", kScene); }

  fs::path path(const std::string& name) const { return folder_.file(name.c_str()); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  std::string read(const std::string& name) const { return read_file(path(name)); }

  // Starts the program in the folder, its streams in files there.
  pid_t start(std::vector<std::string> arguments, const std::string& input = "/dev/null") const {
    arguments.insert(arguments.begin(), TILELIGHT_COMMAND);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (::chdir(path("").c_str()) != 0 || !std::freopen(input.c_str(), "r", stdin) ||
        !std::freopen("stdout.txt", "w", stdout) || !std::freopen("stderr.txt", "w", stderr))
      ::_exit(99);
    ::execv(argv[0], argv.data());
    ::_exit(98);
  }

  Outcome finish(pid_t child) const {
    int status = 0;
    ::waitpid(child, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, read("stdout.txt"), read("stderr.txt")};
  }

  Outcome run(const std::vector<std::string>& arguments, const std::string& input = "/dev/null") const {
    return finish(start(arguments, input));
  }

  // What lies in the folder beside the scene and the streams.
  std::vector<std::string> results() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path(""))) {
      const std::string name = entry.path().filename();
      if (name != "scene.json" && name != "stdout.txt" && name != "stderr.txt") names.push_back(name);
    }
    return names;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Command, RendersEachFormatByItsEndingAndLeavesNothingElse) {
  const std::pair<const char*, std::string> formats[] = {
      {"a.png", "\x89PNG"}, {"a.jpg", "\xFF\xD8\xFF"}, {"a.exr", "\x76\x2F\x31\x01"}};
  for (const auto& [name, magic] : formats) {
    const Outcome outcome = run({"render", "scene.json", "-o", name, "--samples", "1"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out + outcome.err, "");  // no progress where there is no terminal
    EXPECT_EQ(read(name).substr(0, magic.size()), magic);
  }
  EXPECT_EQ(results().size(), 3u);
}

TEST_F(Command, GivesTheSameBytesOnAnyThreadsAndTiles) {
  ASSERT_EQ(run({"render", "scene.json", "-o", "one.png", "--threads", "1"}).code, 0);
  ASSERT_EQ(run({"render", "scene.json", "-o", "two.png", "--threads", "2", "--tile", "16"}).code, 0);
  ASSERT_EQ(run({"render", "scene.json", "-o", "odd.png", "--threads", "3", "--tile", "7"}).code, 0);
  EXPECT_TRUE(read("one.png") == read("two.png"));
  EXPECT_TRUE(read("one.png") == read("odd.png"));
}

TEST_F(Command, GivesTheSameBytesOnEveryInstructionSet) {
  ASSERT_EQ(run({"render", "scene.json", "-o", "best.png"}).code, 0);
  for (const char* isa : {"AVX3", "AVX2", "SSE4", "SCALAR"}) {
    const Outcome outcome = run({"render", "scene.json", "-o", "other.png", "--isa", isa});
    if (outcome.code == 2) continue;  // this machine has it not
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(read("best.png") == read("other.png")) << isa;
  }
}

TEST_F(Command, ReadsASceneFromStandardInput) {
  ASSERT_EQ(run({"render", "scene.json", "-o", "file.png"}).code, 0);
  ASSERT_EQ(run({"render", "-", "-o", "stdin.png"}, "scene.json").code, 0);
  EXPECT_TRUE(read("file.png") == read("stdin.png"));
}

TEST_F(Command, ReplacesAnOldImage) {
  write("a.png", "old");
  ASSERT_EQ(run({"render", "scene.json", "-o", "a.png"}).code, 0);
  EXPECT_NE(read("a.png"), "old");
}

TEST_F(Command, TellsEveryErrorOfASceneWithItsPlace) {
  write("bad.json", R"({"tilelight": 1,
  "image": {"width": 0},
  "objects": [
    {"type": "sphere", "radius": -1},
    {"type": "sphere", "raduis": 1}]})");
  const Outcome outcome = run({"render", "bad.json", "-o", "a.png"});
  EXPECT_EQ(outcome.code, 2);
  for (const char* line : {"bad.json:2:", ": /image/width: ", "bad.json:4:", ": /objects/0/radius: ", "bad.json:5:",
                           ": /objects/1/raduis: ", "radius"})
    EXPECT_NE(outcome.err.find(line), std::string::npos) << line << "\n" << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(Command, RefusesBadUsageWithTwo) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"paint"},
      {"render"},
      {"render", "scene.json"},
      {"render", "scene.json", "-o", "a.gif"},
      {"render", "scene.json", "-o", "a.png", "--samples", "none"},
      {"render", "scene.json", "-o", "a.png", "--width", "0"},
      {"render", "scene.json", "-o", "a.png", "--tile", "0"},
      {"render", "scene.json", "-o", "a.png", "--isa", "Z80"},
      {"render", "scene.json", "--pixel", "70,0"},
      {"render", "scene.json", "--pixel", "1"},
      {"render", "scene.json", "-o", "a.png", "--sample", "1"},
      {"chess", "no fen", "-o", "a.png"},
      {"chess", "8/8/8/8/8/8/8/8"},
      {"plan"},
  };
  for (const auto& arguments : wrong) {
    const Outcome outcome = run(arguments);
    std::string line;
    for (const auto& argument : arguments) line += " " + argument;
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_NE(outcome.err, "") << line;
    EXPECT_EQ(outcome.out, "") << line;
  }
  EXPECT_TRUE(results().empty());
}

TEST_F(Command, RefusesMissingFilesWithOne) {
  const Outcome missing = run({"render", "none.json", "-o", "a.png"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_NE(missing.err.find("none.json"), std::string::npos);
  EXPECT_EQ(run({"render", "scene.json", "-o", "no/such/folder/a.png"}).code, 1);
  EXPECT_EQ(run({"render", "scene.json", "-o", "a.png", "--report", "no/such/r.json"}).code, 1);
  EXPECT_TRUE(results().empty());
}

TEST_F(Command, WritesTheReport) {
  ASSERT_EQ(run({"render", "scene.json", "-o", "a.png", "--samples", "4", "--report", "r.json"}).code, 0);
  EXPECT_NE(read("r.json").find("\"passes\":[1.0,1.0,2.0]"), std::string::npos) << read("r.json");
}

TEST_F(Command, DrawsByTheMethodAndShadingAskedFor) {
  for (const char* method : {"raytrace", "zbuffer", "warnock"}) {
    const Outcome outcome = run({"render", "scene.json", "-o", std::string(method) + ".png", "--algorithm", method,
                                 "--shading", "flat", "--samples", "2"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(read("zbuffer.png"), read("warnock.png"));
  EXPECT_NE(read("zbuffer.png"), read("raytrace.png")) << "rays alone see the mirror";
  const Outcome unknown = run({"render", "scene.json", "-o", "x.png", "--algorithm", "painter"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("zbuffer"), std::string::npos) << unknown.err;
}

TEST_F(Command, WritesALineDrawingAsSvgAndNothingElseAsOne) {
  write("box.json", R"({"camera": {"position": [5, 4, 6]}, "image": {"width": 70, "height": 50},
                        "render": {"algorithm": "roberts", "samples": 1},
                        "objects": [{"type": "box", "min": [-1, -1, -1], "max": [1, 1, 1]}]})");
  const Outcome outcome = run({"render", "box.json", "-o", "box.svg"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string svg = read("box.svg");
  EXPECT_EQ(svg.substr(0, 5), "<svg ");
  EXPECT_NE(svg.find("viewBox=\"0 0 70 50\""), std::string::npos) << svg;
  EXPECT_EQ(svg.find("stroke-dasharray"), std::string::npos) << svg;
  ASSERT_EQ(run({"render", "box.json", "--hidden-lines", "-o", "all.svg"}).code, 0);
  EXPECT_NE(read("all.svg").find("stroke-dasharray"), std::string::npos);

  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"-o", "no.svg", "--algorithm", "zbuffer"}, {"-o", "a.png", "--error-map", "no.svg"}}) {
    std::vector<std::string> arguments = {"render", "box.json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome refused = run(arguments);
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("no.svg"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(results().size(), 3u) << "the scene and two drawings";
}

TEST_F(Command, LaysMethodsSideBySide) {
  const Outcome outcome = run({"compare", "scene.json", "-o", "side/by/side", "--methods", "zbuffer,warnock",
                               "--shadings", "gouraud", "--samples", "1", "--rounds", "1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("compare.html"), std::string::npos);
  const std::string page = read("side/by/side/compare.html");
  for (const char* file : {"reference.png", "zbuffer-gouraud.png", "warnock-gouraud-rays.png", "warnock-work.png"}) {
    EXPECT_NE(page.find(file), std::string::npos) << file;
    EXPECT_FALSE(read(std::string("side/by/side/") + file).empty()) << file;
  }
  EXPECT_EQ(run({"compare", "scene.json", "-o", "x", "--methods", "painter"}).code, 2);
}

TEST_F(Command, ExplainsOnePixelInsteadOfRendering) {
  const Outcome outcome = run({"render", "scene.json", "--pixel", "35,25"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.front(), '{');
  EXPECT_NE(outcome.out.find("\"pixel\":[35,25]"), std::string::npos);
  EXPECT_TRUE(results().empty());
}

TEST_F(Command, TellsThePlanForPeopleAndForPrograms) {
  const Outcome people = run({"plan", "scene.json"});
  EXPECT_EQ(people.code, 0) << people.err;
  EXPECT_NE(people.out.find("predicted"), std::string::npos) << people.out;
  EXPECT_NE(people.out.find("left out"), std::string::npos) << people.out;
  EXPECT_NE(people.out.find("transmission"), std::string::npos) << people.out;
  EXPECT_NE(people.out.find("(would cost "), std::string::npos) << people.out;
  const Outcome programs = run({"plan", "scene.json", "--json"});
  EXPECT_EQ(programs.code, 0);
  EXPECT_EQ(programs.out.front(), '{');
  EXPECT_NE(programs.out.find("\"left_out\""), std::string::npos);
  EXPECT_NE(programs.out.find("\"cost\":\""), std::string::npos);
}

TEST_F(Command, RendersAChessPositionAsItsPrintedSceneDoes) {
  const std::string fen = "8/8/8/4k3/8/8/4P3/4K3";
  const std::vector<std::string> small = {"--width", "64", "--height", "36", "--samples", "1"};
  auto with_small = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), small.begin(), small.end());
    return arguments;
  };
  const Outcome scene = run({"chess", fen, "--detail", "12", "--scene"});
  ASSERT_EQ(scene.code, 0) << scene.err;
  write("chess.json", scene.out);
  ASSERT_EQ(run(with_small({"chess", fen, "-o", "a.png", "--detail", "12"})).code, 0);
  ASSERT_EQ(run(with_small({"render", "chess.json", "-o", "b.png"})).code, 0);
  EXPECT_TRUE(read("a.png") == read("b.png"));
}

TEST_F(Command, StudiesErrorAgainstRunTime) {
  const Outcome outcome = run({"report", "scene.json", "-o", "study/of/it", "--width", "24", "--height", "16",
                               "--samples", "8", "--rounds", "3"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("raytrace, phong, adaptive"), std::string::npos) << outcome.out;
  const std::string html = read("study/of/it/report.html");
  EXPECT_NE(html.find("</html>"), std::string::npos);
  for (const char* name : {"reference.png", "picture.png", "error.png", "told.png"}) {
    EXPECT_NE(html.find(name), std::string::npos) << name;
    EXPECT_EQ(read(std::string("study/of/it/") + name).substr(1, 3), "PNG");
  }
  for (const char* name : {"study.json", "runs.csv", "error_time.svg"})
    EXPECT_FALSE(read(std::string("study/of/it/") + name).empty()) << name;
}

TEST_F(Command, RefusesAStudyThatItCouldNotWrite) {
  write("file", "");
  const Outcome outcome = run({"report", "scene.json", "-o", "file/below"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("file/below"), std::string::npos) << outcome.err;
  EXPECT_EQ(run({"report", "scene.json", "-o", "study", "--samples", "7"}).code, 2);
}

TEST_F(Command, PrintsSchemaVersionAndHelp) {
  EXPECT_NE(run({"schema"}).out.find("https://json-schema.org/draft/2020-12/schema"), std::string::npos);
  EXPECT_EQ(run({"--version"}).out.substr(0, 10), "tilelight ");
  for (const char* command : {"render", "plan", "report", "compare", "chess", "schema"}) {
    const Outcome help = run({command, "--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("Example"), std::string::npos) << command;
  }
}

// Whether the process has a handler for the signal, as Linux tells it.
bool catches(pid_t process, int signal) {
  const std::string status = read_file("/proc/" + std::to_string(process) + "/status");
  const size_t at = status.find("SigCgt:");
  return at != std::string::npos && (std::stoull(status.substr(at + 7), nullptr, 16) >> (signal - 1) & 1) != 0;
}

TEST_F(Command, EndsCleanlyOnCtrlC) {
  write("a.png", "old");
  const pid_t child = start({"render", "scene.json", "-o", "a.png", "--width", "2000", "--height", "2000", "--samples",
                             "4096", "--threads", "1"});
  while (!catches(child, SIGINT)) std::this_thread::yield();
  ::kill(child, SIGINT);
  const Outcome outcome = finish(child);
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_EQ(read("a.png"), "old");
  EXPECT_EQ(results(), std::vector<std::string>{"a.png"});
}

}  // namespace
}  // namespace tilelight
