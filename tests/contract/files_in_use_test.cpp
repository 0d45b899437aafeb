// What a command reads it never writes over, and no two of its outputs are one file: for every command and option of
// the program's own list, and every way to name a file.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "crankloop/command_line/commands.hpp"
#include "support/bad_input.hpp"

namespace crankloop::bad_input::files_in_use_test {
namespace {

namespace fs = std::filesystem;
using program::Command, program::Option;

constexpr const char* kEngines = CRANKLOOP_SOURCE_DIR "/tools/engines/";

/// Whether help calls the option's value a file: F, F.html, FILE.fmu or PATH.
bool names_a_file(const Option& option) {
  if (option.kind != Option::Kind::text) return false;
  const std::string value = option.value;
  return value == "F" || value == "PATH" || (value[0] == 'F' && value.find('.') != std::string::npos);
}

std::vector<const Option*> outputs_of(const Command& command) {
  std::vector<const Option*> outputs;
  for (const Option& option : command.options) {
    if (names_a_file(option)) outputs.push_back(&option);
  }
  return outputs;
}

class FilesInUse : public BadInput {
 protected:
  /// The engines of the commands' examples, their valve lift and, where one has a diagram, their pressure measured.
  FilesInUse() {
    fs::copy(std::string(kEngines) + "cam_495.csv", in("lift.csv"));
    fs::copy(std::string(kEngines) + "pressure_495.csv", in("trace.csv"));
    const std::string measured = with_measured_lift(sample_).text();
    const std::size_t pressure = measured.find("[pressure]");
    const std::string by_trace = measured.substr(0, pressure) +
                                 "[pressure]\nsource = angle_table\nfile = trace.csv\n\n" +
                                 measured.substr(measured.find("[friction]", pressure));
    write("diesel_495.ini", by_trace);
    write("ohc_125.ini", by_trace);
    write("four_2000.ini", with_measured_lift(Engine(contents(std::string(kEngines) + "four_2000.ini"))).text());
    fs::create_directory(in("my_engine_fmu"));
    write("my_engine_fmu/one.txt", "one\n");
  }
  static Engine with_measured_lift(const Engine& engine) {
    return engine.changed("source = polynomial", "source = table")
        .changed("max_lift_mm", "file = lift.csv")
        .changed("half_angle_deg", "smoothing_um = 50")
        .changed("exponents", "");
  }
  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }

  /// A command's example, its files in the folder, without its outputs.
  [[nodiscard]] std::vector<std::string> example_of(const Command& command) const {
    std::vector<std::string> words;
    std::istringstream example(command.example);
    std::string word;
    for (example >> word; example >> word && word != ">";) {
      const bool is_output = word == "-o" || word == "--at" /* of --svg */ ||
                             std::any_of(command.options.begin(), command.options.end(),
                                         [&](const Option& o) { return o.name == word && names_a_file(o); });
      if (is_output) {
        example >> word;
      } else {
        words.push_back(fs::exists(in(word)) ? in(word) : word);
      }
    }
    return words;
  }

  /// What the example reads, all of which has to be as it was.
  [[nodiscard]] static std::vector<std::string> files_read_by(const Command& command) {
    if (command.files == 0) return {};
    const std::string example = command.example;
    if (example.find("my_engine_fmu") != std::string::npos) return {"my_engine_fmu/one.txt"};
    if (example.find("four_2000.ini") != std::string::npos) return {"four_2000.ini", "lift.csv"};
    return {example.find("ohc_125.ini") != std::string::npos ? "ohc_125.ini" : "diesel_495.ini", "lift.csv",
            "trace.csv"};
  }

  void expect_untouched(const std::string& file, const std::string& before, const std::vector<std::string>& words) {
    EXPECT_EQ(contents(in(file)), before) << "written over by: " << testing::PrintToString(words);
  }
  void expect_refused(const std::vector<std::string>& words, const std::string& path, const std::string& reason) {
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, kBadInput) << testing::PrintToString(words) << answer.error;
    EXPECT_EQ(answer.out, "");
    EXPECT_NE(answer.error.find(path + ": "), std::string::npos) << answer.error << "  should name " << path;
    EXPECT_NE(answer.error.find(reason), std::string::npos) << answer.error << "  should say: " << reason;
    EXPECT_EQ(std::count(answer.error.begin(), answer.error.end(), '\n'), 1) << answer.error;
  }
  /// --part is the output of a shard, and the only one.
  static bool is_part(const Option& option) { return option.name == std::string("--part"); }
  static std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    const bool free = std::any_of(more.begin(), more.end(),
                                  [](const std::string& word) { return word == "--analogue" || word == "--cranking"; });
    if (free) {  // is for a run without a given speed
      const auto speed = std::find(words.begin(), words.end(), "--rpm");
      if (speed != words.end()) words.erase(speed, speed + 2);
      words.emplace_back("--free");
    }
    return words;
  }
};

TEST_F(FilesInUse, AreWrittenOverByNoOptionOfAnyCommand) {
  int tried = 0;
  for (const Command* command : program::commands()) {
    std::vector<std::string> words = example_of(*command);
    if (command->files > 0) words.emplace_back("--no-warnings");
    for (const std::string& file : files_read_by(*command)) {
      const std::string before = contents(in(file));
      fs::create_symlink(in(file), in("link"));
      fs::create_hard_link(in(file), in("twin"));
      for (const Option& option : command->options) {
        if (option.kind != Option::Kind::text) continue;
        const bool follows = option.value != std::string("PATH");  // a block of shared memory is behind no link
        for (const std::string& name : {file, std::string("link"), std::string("twin")}) {
          std::vector<std::string> all = with(words, {option.name, in(name)});
          if (is_part(option)) all = with(all, {"--shard", "1/1"});
          if (names_a_file(option)) {
            expect_refused(all, name == "twin" || !follows ? in(name) : in(file),
                           "this command reads it; write to another file");
            ++tried;
          } else if (std::find(words.begin(), words.end(), option.name) == words.end()) {
            (void)run(all);  // refused or not, by what the option is for
          }
          expect_untouched(file, before, all);
        }
      }
      fs::remove(in("link"));
      fs::remove(in("twin"));
    }
  }
  EXPECT_GE(tried, 3 * (2 * 15 + 1)) << "options that write: have any lost their file?";
}

TEST_F(FilesInUse, AreNamedForOneOutputAlone) {
  int tried = 0;
  fs::create_symlink("new", in("link"));
  for (const Command* command : program::commands()) {
    const std::vector<const Option*> outputs = outputs_of(*command);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      for (std::size_t k = i + 1; k < outputs.size(); ++k) {
        if (is_part(*outputs[i]) || is_part(*outputs[k])) continue;
        for (const std::string name : {"new", "link"}) {
          const std::vector<std::string> words =
              with(example_of(*command), {outputs[i]->name, in("new"), outputs[k]->name, in(name)});
          const Answer answer = run(words);
          EXPECT_EQ(answer.status, kBadInput) << testing::PrintToString(words) << answer.error;
          EXPECT_NE(answer.error.find("named for two outputs"), std::string::npos) << answer.error;
          EXPECT_FALSE(fs::exists(in("new"))) << testing::PrintToString(words);
          ++tried;
        }
      }
    }
  }
  EXPECT_GE(tried, 2 * (1 + 1 + 3 + 1 + 1 + 6));
  const Answer answer = run({"run", in("diesel_495.ini"), "--csv", "-", "--report", "-"});
  EXPECT_EQ(answer.status, kBadInput);
  EXPECT_NE(answer.error.find("-: named for two outputs"), std::string::npos) << answer.error;
}

TEST_F(FilesInUse, AreNoPlaceForStandardOutputEither) {
  const std::string trace = contents(in("trace.csv"));
  const auto shell = [&](const std::string& command) {
    const int status = std::system((std::string("'") + CRANKLOOP_PROGRAM + "' " + command).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  const std::string engine = "'" + in("diesel_495.ini") + "' --no-warnings ";
  EXPECT_EQ(shell("run " + engine + "--csv - >>'" + in("trace.csv") + "' 2>'" + in("err") + "'"), kBadInput);
  EXPECT_NE(contents(in("err")).find("trace.csv: this command reads it, and standard output goes there"),
            std::string::npos)
      << contents(in("err"));
  EXPECT_EQ(contents(in("trace.csv")), trace);
  EXPECT_EQ(shell("run " + engine + "--csv - >'" + in("out") + "' 2>>'" + in("trace.csv") + "'"), kBadInput);
  const std::string said = "trace.csv: this command reads it, and stderr goes there";
  EXPECT_NE(contents(in("trace.csv")).find(said), std::string::npos);

  fs::copy(in("diesel_495.ini"), in("lost.ini"));  // > empties it before the program begins: all it can do is say so
  EXPECT_EQ(shell("show '" + in("lost.ini") + "' >'" + in("lost.ini") + "' 2>'" + in("err") + "'"), kBadInput);
  EXPECT_NE(contents(in("err")).find("the shell has emptied the file already"), std::string::npos)
      << contents(in("err"));

  write("trace.csv", trace);
  EXPECT_EQ(shell("run " + engine + "--csv '" + in("out") + "' >'" + in("out") + "' 2>'" + in("err") + "'"), kBadInput);
  EXPECT_NE(contents(in("err")).find("out: standard output goes there too"), std::string::npos) << contents(in("err"));
}

TEST_F(FilesInUse, MayBeAPipeOfOneOutputAloneOrTheDeviceThatKeepsNothing) {
  const auto through_cat = [&](const std::string& outputs) {
    const std::string command = std::string("'") + CRANKLOOP_PROGRAM + "' run '" + in("diesel_495.ini") +
                                "' --rpm 2000 --cycles 1 --no-warnings " + outputs + " 2>'" + in("err") + "' | cat >'" +
                                in("out") + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
  };
  through_cat("--csv '" + in("table.csv") + "'");
  const std::string table = contents(in("table.csv"));
  ASSERT_NE(contents(in("out")).find("\nfaulty_ticks = "), std::string::npos);
  through_cat("--csv /dev/stdout");
  EXPECT_EQ(contents(in("out")), table) << "and the summary elsewhere, as with --csv -";
  EXPECT_NE(contents(in("err")).find("\nfaulty_ticks = "), std::string::npos) << contents(in("err"));
  for (const char* outputs : {"--csv /dev/stdout --report /dev/stdout", "--csv - --report /dev/stdout",
                              "--csv /dev/fd/3 --report /dev/fd/4 3>&1 4>&1 >/dev/null"}) {
    through_cat(outputs);
    EXPECT_NE(contents(in("err")).find(": named for two outputs, "), std::string::npos) << outputs;
    EXPECT_EQ(contents(in("out")), "") << outputs;
  }
  const Answer nothing_kept =
      run({"run", in("diesel_495.ini"), "--no-warnings", "--csv", "/dev/null", "--report", "/dev/null"}, "/dev/null");
  EXPECT_EQ(nothing_kept.status, 0);
  EXPECT_EQ(nothing_kept.error, "");
}

TEST_F(FilesInUse, OfAPackedFolderAreNotThePackage) {
  EXPECT_EQ(run({"pack", in("my_engine_fmu"), "-o", in("my_engine_fmu/new.fmu")}).status, 0);
  const std::string packed = contents(in("my_engine_fmu/new.fmu"));
  expect_refused({"pack", in("my_engine_fmu"), "-o", in("my_engine_fmu/new.fmu")}, in("my_engine_fmu/new.fmu"),
                 "this command reads it");
  EXPECT_EQ(contents(in("my_engine_fmu/new.fmu")), packed);
}

TEST_F(FilesInUse, ThatALinkNamesAreMadeBehindIt) {
  fs::create_directory(in("results"));
  fs::create_symlink("results/k.csv", in("first.csv"));
  fs::create_symlink("first.csv", in("second.csv"));
  EXPECT_EQ(run({"forces", in("diesel_495.ini"), "--csv", in("second.csv")}).status, 0);
  EXPECT_TRUE(fs::is_symlink(in("second.csv")) && fs::is_symlink(in("first.csv")));
  EXPECT_EQ(contents(in("results/k.csv")), run({"forces", in("diesel_495.ini")}).out);

  const std::string to_a_pipe = std::string("'") + CRANKLOOP_PROGRAM + "' forces '" + in("diesel_495.ini") +
                                "' --csv /dev/stdout | cat >'" + in("piped.csv") + "'";
  EXPECT_EQ(std::system(to_a_pipe.c_str()), 0);
  EXPECT_EQ(contents(in("piped.csv")), contents(in("results/k.csv"))) << "a link of the kernel's, to what has no path";

  fs::create_symlink("ring_b.csv", in("ring_a.csv"));
  fs::create_symlink("ring_a.csv", in("ring_b.csv"));
  fs::create_symlink("nowhere/k.csv", in("lost.csv"));
  for (const std::string name : {"ring_a.csv", "lost.csv"}) {
    const Answer answer = run({"forces", in("diesel_495.ini"), "--csv", in(name)});
    EXPECT_EQ(answer.status, kFailure);
    EXPECT_NE(answer.error.find(" cannot be created: "), std::string::npos) << answer.error;
    EXPECT_TRUE(fs::is_symlink(in(name))) << name;
  }
}

}  // namespace
}  // namespace crankloop::bad_input::files_in_use_test
