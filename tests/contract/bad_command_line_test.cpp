// Bad command lines are told with the usage of their command; an output file appears whole or not at all.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/bad_input.hpp"

namespace crankloop::bad_input::bad_command_line_test {
namespace {

/// Everything wrong with a command line is told with the command's usage.
class BadCommandLine : public BadInput {
 protected:
  void expect_usage(const std::vector<std::string>& words, const std::vector<std::string>& fragments) const {
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, kBadInput) << answer.error;
    EXPECT_EQ(answer.out, "");
    for (const std::string& fragment : fragments) {
      EXPECT_NE(answer.error.find(fragment), std::string::npos) << answer.error << "  should say: " << fragment;
    }
  }
};

TEST_F(BadCommandLine, IsToldWithTheUsageOfItsCommand) {
  expect_usage({}, {"a command is missing"});
  expect_usage({"shw"}, {"unknown command 'shw'", "did you mean show?"});
  expect_usage({"help", "kinematic"}, {"did you mean kinematics?"});
  expect_usage({"help", "run", "extra"},
               {"crankloop help: unexpected argument 'extra'", "usage: crankloop help [COMMAND]"});
  expect_usage({"--version", "run"}, {"crankloop --version: unexpected argument 'run'", "usage: crankloop --version"});
  expect_usage({"show"}, {"a file name is missing", "usage: crankloop show FILE"});
  expect_usage({"show", kSample, "another"}, {"unexpected argument 'another'"});
  expect_usage({"show", kSample, "--rpm", "3"}, {"unknown option '--rpm'"});
  for (const char* name : {"int", "requires", "2nd", "a b"})
    expect_usage({"tables", kSample, "--namespace", name}, {"--namespace must be a C++ identifier, and no keyword"});
  const std::string usage = "usage: crankloop kinematics FILE";
  const auto kinematics = [&](std::vector<std::string> words, const std::string& complaint) {
    words.insert(words.begin(), {"kinematics", kSample});
    expect_usage(words, {complaint, usage});
  };
  kinematics({"--rpm"}, "--rpm needs a value");
  kinematics({"--rpm", "--step-deg"}, "--rpm needs a value");
  kinematics({"--rpm="}, "--rpm: the value is missing");
  kinematics({"--rpm", "2000", "--rpm=2000"}, "--rpm is given twice");
  kinematics({"--rpm", "2000", "--speed-rad-s", "210"}, "exclude each other");
  kinematics({"--rpm", "2000rpm"}, "'rpm' follows it");
  kinematics({"--rpm", "nan"}, "not a finite number");
  kinematics({"--rpm", "1e9"}, "out of range");
  kinematics({"--rmp", "2000"}, "did you mean --rpm?");
  kinematics({"--rpm", "2000", "--method", "tabel"}, "did you mean table?");
  expect_usage({"masses"}, {"--type, --bore-mm, --speed-rpm are missing", "usage: crankloop masses"});
  expect_usage({"map", kSample, "--throttle", "0:1:3"}, {"--rpm is missing"});
}

TEST_F(BadCommandLine, RefusesAnOptionThatWouldHaveNoEffect) {
  const auto nothing_alone = [&](std::vector<std::string> words, const std::string& without) {
    const std::string option = words[words.size() - 2];
    expect_usage(words, {option + " has no effect without " + without + "; give both", "usage: crankloop " + words[0]});
  };
  nothing_alone({"live", kSample, "--ring-edges", "64"}, "--shared");
  nothing_alone({"live", kSample, "--lead-ticks", "2"}, "--shared");
  nothing_alone({"live", kSample, "--silent-ms", "50"}, "--shared");
  nothing_alone({"cam", kSample, "--train", "intake", "--at", "5"}, "--svg");
  nothing_alone({"bench", "--ticks", "5"}, "--kernel");
}

TEST_F(BadCommandLine, RefusesOptionsOfWhichOneWouldBeIgnored) {
  const std::string page = folder_ / "page.html";
  expect_usage({"stress", "--case", "1", "--report", page}, {"--case and --report exclude each other; give one"});
  expect_usage({"stress", "--case", "1", "--cases", "5"}, {"--case and --cases exclude each other"});
  expect_usage({"bench", "--kernel", "torque-float", "--csv", page}, {"--kernel and --csv exclude each other"});
  EXPECT_FALSE(std::filesystem::exists(page));
  expect_usage(
      {"study", kSample, "--vary", "rpm=1000:2000:2", "--set", "train=intake", "rpm=1500", "--of", "valve.max_lift"},
      {"--set: rpm is varied; give it once", "usage: crankloop study"});
}

TEST_F(BadCommandLine, NamesTheLeastEventBudgetOfTheEngineAndTheTick) {
  // `show` has 2 fine steps in the worst tick of 100 us; an event takes 2 more.
  expect_usage({"tables", kSample, "--event-budget", "3"},
               {"crankloop tables: --event-budget: 3 is too small: a valve needs 4 here; allowed: 4 to 32768",
                "usage: crankloop tables"});
  const std::string least = "a valve needs 8 here; allowed: 8 to 32768";
  expect_usage({"tables", kSample, "--tick-us", "500", "--event-budget", "7"}, {least});
  expect_usage({"tables", kSample, "--tick-us", "500", "--event-budget", "7", "--real", "double"}, {least});
  EXPECT_EQ(run({"tables", kSample, "--tick-us", "500", "--event-budget", "8"}).status, 0);
}

TEST_F(BadCommandLine, RefusesARunThatIsShorterThanATick) {
  for (const std::string seconds : {"1e-12", "0.00009"}) {
    expect_usage({"run", kSample, "--free", "--seconds", seconds}, {"is shorter than a tick of 100 us"});
    EXPECT_NE(run({"run", kSample, "--free", "--seconds", seconds}).error.find("--seconds: "), std::string::npos);
  }
  EXPECT_NE(run({"run", kSample, "--free", "--seconds", "0.0001"}).out.find("\nticks = 1\n"), std::string::npos);
}

TEST_F(BadCommandLine, WritesANumberThatIsOutOfRangeInDigits) {
  expect_usage({"run", kSample, "--cycles", "2147483648"}, {"--cycles: 2147483648 is out of range; allowed: 1 to "});
}

TEST_F(BadCommandLine, NamesAProcessorThatIsNotThere) {
  expect_usage({"live", kSample, "--seconds", "1", "--cpu", "1023"},
               {"--cpu 1023: this process may not use such a processor"});
}

TEST_F(BadCommandLine, TakesOutputByAnyOfItsNames) {
  std::filesystem::create_directory(folder_ / "packed");
  write("packed/one.txt", "one");
  for (const std::string name : {"-o", "--output", "--out"}) {
    for (const auto& [command, input] : {std::pair{"tables", std::string(kSample)}, {"pack", folder_ / "packed"}}) {
      const std::filesystem::path file = folder_ / (command + name);
      const Answer answer = run({command, input, name, file});
      EXPECT_EQ(answer.status, 0) << answer.error;
      EXPECT_EQ(answer.out, "");
      EXPECT_TRUE(std::filesystem::exists(file)) << command << " " << name;
    }
  }
  expect_usage({"pack", folder_ / "packed"}, {"--output is missing", "usage: crankloop pack"});
  expect_usage({"page", kSample, "-o", "x", "--output", "y"}, {"--out is given twice"});
  expect_usage({"show", kSample, "-o", "x"}, {"unknown option '-o'"});
}

TEST_F(BadCommandLine, CarriesNoControlCodesToTheTerminal) {
  const std::vector<std::vector<std::string>> cases = {
      {"\x1b[31mrun"}, {"show", "\x1b]0;title\x07"}, {"show", kSample, "--\x1b[2J"}, {"show", "two\nlines.ini"}};
  for (const std::vector<std::string>& words : cases) {
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, kBadInput);
    EXPECT_EQ(answer.error,
              "crankloop: word " + std::to_string(words.size()) + " of the command line has a control character\n");
  }
}

TEST_F(BadCommandLine, ShowsANewlineOfAPackedFilesNameAsWhatItIs) {
  std::filesystem::create_directory(folder_ / "packed");
  const auto refusal_of = [&](const std::string& name) {
    write("packed/" + name, "one");
    const Answer answer = run({"pack", folder_ / "packed", "-o", folder_ / "packed.fmu"});
    std::filesystem::remove(folder_ / ("packed/" + name));
    EXPECT_EQ(answer.status, kBadInput);
    return answer.error;
  };
  EXPECT_EQ(refusal_of("two\nlines\x1b[31m.txt"), "two\\x0Alines\\x1B[31m.txt: names in an archive are ASCII\n");
  EXPECT_EQ(refusal_of("caf\xC3\xA9"), "caf\xC3\xA9: names in an archive are ASCII\n");
  EXPECT_EQ(refusal_of("caf\xE9"), "caf\\xE9: names in an archive are ASCII\n") << "no UTF-8";
  std::filesystem::create_directory(folder_ / "packed/a\nfolder");
  std::filesystem::create_symlink("nowhere", folder_ / "packed/a\nfolder/link");
  expect_refusal(run({"pack", folder_ / "packed", "-o", folder_ / "packed.fmu"}),
                 (folder_ / "packed/a\\x0Afolder/link"), {"cannot be read"});
}

TEST_F(BadCommandLine, OfValvesIsToldWithTheUsageOfItsCommand) {
  const auto valve = [&](std::vector<std::string> words, const std::string& complaint) {
    words.insert(words.begin(), {"valve", kSample});
    expect_usage(words, {complaint, "usage: crankloop valve FILE"});
  };
  valve({"--rpm", "2000"}, "--train is missing; " + std::string(kSample) + " has intake, exhaust");
  valve({"--train", "intake", "--rpm", "0"}, "would never turn");
  valve({"--train", "intake", "--rpm", "200000"}, "out of range");
  valve({"--train", "intake", "--rpm", "2000", "--accuracy-um", "0"}, "out of range");
  valve({"--train", "intake", "--rpm", "2000", "--integrator", "rk5"}, "did you mean rk4?");
  valve({"--train", "intake", "--rpm", "2000", "--cycles", "0"}, "out of range");
  valve({"--train", "intake", "--rpm", "40000", "--tick-us", "2000"}, "at most one revolution per tick");
  valve({"--train", "intake", "--rpm", "0.0001"}, "ticks of 20 us");
  const auto redline = [&](std::vector<std::string> words, const std::string& complaint) {
    words.insert(words.begin(), {"redline", kSample, "--train", "intake"});
    expect_usage(words, {complaint, "usage: crankloop redline FILE"});
  };
  redline({"--from", "3000", "--to", "2000"}, "--from must be less than --to");
  redline({"--from", "1500.5"}, "not a whole number");
  redline({"--vary", "springs"}, "did you mean spring?");
}

TEST_F(BadCommandLine, LacksNothingThatTheFileAnswers) {
  constexpr const char* k125 = CRANKLOOP_SOURCE_DIR "/tools/engines/ohc_125.ini";
  const auto expect_same = [&](const std::vector<std::string>& brief, std::vector<std::string> rest) {
    rest.insert(rest.begin(), brief.begin(), brief.end());
    const Answer answer = run(brief);
    EXPECT_EQ(answer.status, 0) << answer.error;
    EXPECT_EQ(answer.out, run(rest).out) << brief[0];
  };
  expect_same({"kinematics", kSample, "--step-deg", "30"}, {"--rpm", "2000"});
  expect_same({"forces", kSample, "--step-deg", "30"}, {"--rpm", "2000"});
  expect_same({"balance", kSample}, {"--rpm", "2000"});
  expect_same({"tables", kSample}, {"--tick-us", "100"});
  expect_same({"lift", k125, "--step-deg", "30"}, {"--train", "intake"});
  expect_same({"valve", k125}, {"--train", "intake", "--rpm", "7000", "--tick-us", "20"});
  expect_same({"redline", k125, "--from", "3000", "--to", "4000"}, {"--train", "intake"});
  const std::string sample = contents(k125);
  write("train.ini",
        sample.substr(sample.find("[cam intake]"), sample.find("# Trigger") - sample.find("[cam intake]")));
  expect_usage({"valve", folder_ / "train.ini"}, {"--rpm is missing", "has no [engine] with a rated_rpm"});
}

TEST_F(BadCommandLine, HelpIsNoMistake) {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{{"--help"},
                                                                                     {"help"},
                                                                                     {"help", "show"},
                                                                                     {"show", "--help"},
                                                                                     {"help", "engine-file"},
                                                                                     {"help", "patterns"},
                                                                                     {"--version"}}) {
    const Answer answer = run(words);
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(answer.error, "");
    EXPECT_NE(answer.out, "");
  }
}

/// Output that cannot be written is a failure of the machine, not of the input, and leaves no half file behind.
class Output : public BadInput {
 protected:
  /// A run that is long in writing its file, once it has begun to.
  pid_t start_long_run(const std::string& name = "r.csv") const {
    const pid_t child = start({"run", kSample, "--cycles", "1000000", "--csv", folder_ / name}, folder_ / "stdout");
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (unfinished().empty() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(unfinished().size(), 1u);
    return child;
  }
  std::vector<std::string> unfinished() const {
    std::vector<std::string> found;
    for (const std::string& name : files()) {
      if (name.find(".unfinished-") != std::string::npos) found.push_back(name);
    }
    return found;
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(BadCommandLine, HelpSaysWhatErrorsLookLikeAndWhatAKeyUsuallyIs) {
  const std::string help = run({"help"}).out;
  for (const char* text :
       {"FILE:LINE: what is wrong", "crankloop COMMAND: what is wrong", "exit status 2", "exit status 1"}) {
    EXPECT_NE(help.find(text), std::string::npos) << text;
  }
  const std::string keys = run({"help", "engine-file"}).out;
  const auto about = [&keys](const std::string& key) {
    const auto at = keys.find("\n  " + key + " ");
    EXPECT_NE(at, std::string::npos) << key;
    return keys.substr(at + 1, keys.find('\n', at + 1) - at - 1);
  };
  EXPECT_NE(about("bore_mm").find("; required"), std::string::npos) << about("bore_mm");
  EXPECT_NE(about("net_mep_kPa").find("; required, or heat_J"), std::string::npos) << about("net_mep_kPa");
  EXPECT_NE(about("rod_g").find("; required, or rod_small_end_g and rod_big_end_g"), std::string::npos)
      << about("rod_g");
  EXPECT_NE(about("every").find("; required, or misses and of_cycles, or random_ratio, or burst and gap, or cycles"),
            std::string::npos)
      << about("every");
  EXPECT_EQ(about("crankcase_kPa").find("required"), std::string::npos);
  EXPECT_NE(about("wiebe_m").find("; default 0.9; usual 0.7 to 3"), std::string::npos) << about("wiebe_m");
  EXPECT_NE(about("compression_ratio").find("; usual "), std::string::npos) << about("compression_ratio");
}

TEST_F(Output, IsNotTouchedByBadInput) {
  write("old.csv", "precious\n");
  write("engine.ini", sample_.with("bore_mm", "-1").text());
  EXPECT_EQ(run({"kinematics", path_, "--rpm", "2000", "--csv", folder_ / "new.csv"}).status, kBadInput);
  EXPECT_EQ(run({"kinematics", path_, "--rpm", "2000", "--csv", folder_ / "old.csv"}).status, kBadInput);
  EXPECT_EQ(files(), (std::vector<std::string>{"engine.ini", "old.csv", "stderr", "stdout"}));
  EXPECT_EQ(contents(folder_ / "old.csv"), "precious\n");
}

TEST_F(Output, AppearsWhole) {
  const Answer answer = run({"kinematics", kSample, "--rpm", "2000"});
  EXPECT_EQ(answer.status, 0);
  const std::string summary = run({"kinematics", kSample, "--rpm", "2000", "--csv", folder_ / "k.csv"}).out;
  EXPECT_NE(summary.find("max_acceleration = "), std::string::npos) << summary;
  EXPECT_EQ(contents(folder_ / "k.csv"), answer.out);
  EXPECT_EQ(files(), (std::vector<std::string>{"k.csv", "stderr", "stdout"}));
}

TEST_F(Output, OfAProgramThatASignalEndsIsTakenAway) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    write("r.csv", "precious\n");
    const pid_t child = start_long_run();
    kill(child, number);
    EXPECT_EQ(status_of(child), -number) << "whoever waits for it sees by what it ended";
    EXPECT_EQ(unfinished(), std::vector<std::string>{}) << number;
    EXPECT_EQ(contents(folder_ / "r.csv"), "precious\n");
  }
}

TEST_F(Output, OfAnFmuThatASignalEndsLeavesNothingAtAnyMoment) {
  std::filesystem::create_directory(folder_ / "temporary");
  ASSERT_EQ(setenv("TMPDIR", (folder_ / "temporary").c_str(), 1), 0);
  const auto pack = [&] { return start({"fmu", kSample, "-o", folder_ / "engine.fmu"}, folder_ / "stdout"); };
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  (void)status_of(pack());
  const auto whole = Clock::now() - begin;
  std::filesystem::remove(folder_ / "engine.fmu");
  constexpr int kMoments = 12;  // of each signal
  int ended_by_it = 0;
  for (int moment = 0; moment < kMoments; ++moment) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGKILL}) {
      const pid_t child = pack();
      std::this_thread::sleep_for(whole * (2 * moment + 1) / (2 * kMoments));
      kill(child, number);
      ended_by_it += status_of(child) == -number ? 1 : 0;
      EXPECT_TRUE(std::filesystem::is_empty(folder_ / "temporary")) << number << " at moment " << moment;
      if (number != SIGKILL) {
        EXPECT_EQ(unfinished(), std::vector<std::string>{}) << number;
      }
      for (const std::string& name : unfinished()) std::filesystem::remove(folder_ / name);
      std::filesystem::remove(folder_ / "engine.fmu");
    }
  }
  EXPECT_GT(ended_by_it, kMoments) << "most of them have to come while it runs";
  unsetenv("TMPDIR");
}

TEST_F(Output, BeyondTheLargestFileAllowedIsAFailureThatLeavesNothing) {
  const std::string command = "ulimit -f 100; exec '" CRANKLOOP_PROGRAM "' run '" + std::string(kSample) +
                              "' --cycles 1000 --csv '" + (folder_ / "r.csv") + "' 2>'" + (folder_ / "stderr") + "'";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == kFailure) << status;
  EXPECT_NE(contents(folder_ / "stderr").find("r.csv cannot be written: File too large"), std::string::npos)
      << contents(folder_ / "stderr");
  EXPECT_EQ(files(), std::vector<std::string>{"stderr"});
}

TEST_F(Output, LeftByAKilledRunIsTakenAwayByTheNextAndThatOfARunningOneIsNot) {
  const pid_t killed = start_long_run();
  kill(killed, SIGKILL);  // which no program can see coming
  EXPECT_EQ(status_of(killed), -SIGKILL);
  ASSERT_EQ(unfinished().size(), 1u);
  const std::string of_another = "r.csv.unfinished-1-x";  // not a name that the program gives
  write(of_another, "somebody's\n");
  EXPECT_EQ(run({"kinematics", kSample, "--rpm", "2000", "--csv", folder_ / "other.csv"}).status, 0);
  EXPECT_EQ(unfinished().size(), 2u) << "another output's";
  EXPECT_EQ(run({"kinematics", kSample, "--rpm", "2000", "--csv", folder_ / "r.csv"}).status, 0);
  EXPECT_EQ(unfinished(), std::vector<std::string>{of_another});
  std::filesystem::remove(folder_ / of_another);

  const pid_t running = start_long_run();
  EXPECT_EQ(run({"kinematics", kSample, "--rpm", "2000", "--csv", folder_ / "r.csv"}).status, 0);
  EXPECT_EQ(unfinished().size(), 1u);
  kill(running, SIGTERM);
  EXPECT_EQ(status_of(running), -SIGTERM);
}

TEST_F(Output, HasANameOfAnyLengthThatAFileMayHave) {
  constexpr std::size_t kLongest = 255;
  std::string euros;  // of three bytes each
  while (euros.size() < kLongest) euros += "\u20AC";
  for (const std::string& name : {std::string(240, 'a'), std::string(kLongest, 'a'), euros}) {
    const pid_t killed = start_long_run(name);
    kill(killed, SIGKILL);
    EXPECT_EQ(status_of(killed), -SIGKILL);
    ASSERT_EQ(unfinished().size(), 1u);
    const std::size_t kept = unfinished().front().find(".unfinished-");
    EXPECT_EQ(unfinished().front().substr(0, kept), name.substr(0, kept));
    if (name == euros) {
      EXPECT_EQ(kept % 3, 0u) << "a character is cut";
    }
    EXPECT_EQ(run({"kinematics", kSample, "--rpm", "2000", "--csv", folder_ / name}).status, 0);
    EXPECT_EQ(unfinished(), std::vector<std::string>{});
    EXPECT_EQ(contents(folder_ / name), run({"kinematics", kSample, "--rpm", "2000"}).out);
  }
}

TEST_F(Output, ThatCannotBeWrittenIsAFailure) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"show", kSample}, {"--help"}, {"kinematics", kSample, "--rpm", "2000"}}) {
    const Answer closed = run(words, "");
    EXPECT_EQ(closed.status, kFailure);
    EXPECT_NE(closed.error.find("standard output cannot be written"), std::string::npos) << closed.error;
    const Answer full = run(words, "/dev/full");
    EXPECT_EQ(full.status, kFailure);
    EXPECT_NE(full.error.find("No space left"), std::string::npos) << full.error;
  }
  const Answer nowhere = run({"kinematics", kSample, "--rpm", "2000", "--csv", folder_ / "no/such/folder.csv"});
  EXPECT_EQ(nowhere.status, kFailure);
  EXPECT_NE(nowhere.error.find("folder.csv cannot be created: No such file or directory"), std::string::npos)
      << nowhere.error;
  EXPECT_EQ(run({"kinematics", kSample, "--rpm", "2000", "--csv", folder_.path()}).status, kFailure);
  EXPECT_EQ(run({"kinematics", kSample, "--rpm", "2000", "--csv", "/dev/full"}).status, kFailure);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));  // not replaced by a file
}

}  // namespace
}  // namespace crankloop::bad_input::bad_command_line_test
