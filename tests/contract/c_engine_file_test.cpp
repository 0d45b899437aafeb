// Engine files for C: the definition that the program reads, or the lines that it would print.
#include <crankloop/crankloop_engine_file.h>

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "c_api.hpp"
#include "crankloop/engine_file/engine_file.hpp"
#include "support/files.hpp"

namespace crankloop::c_api::c_engine_file_test {
namespace {

const char* const kDiesel = CRANKLOOP_SOURCE_DIR "/tools/engines/diesel_495.ini";

struct Free {
  void operator()(crankloop_engine_file* file) const { crankloop_engine_file_free(file); }
};
using File = std::unique_ptr<crankloop_engine_file, Free>;

std::string text_of(const char* path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}
/// What is said of a text that stands for the file `path`; "" where it is read.
std::string errors_of(const std::string& text, const char* path = "engine.ini") {
  char errors[4000];
  const File file(crankloop_engine_file_read(path, text.data(), text.size(), errors, sizeof errors));
  EXPECT_EQ(file == nullptr, errors[0] != '\0');
  return errors;
}
std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

template <class Api>
class CEngineFile : public CEngine<Api> {};
TYPED_TEST_SUITE(CEngineFile, AllApis, ApiName);

TYPED_TEST(CEngineFile, TurnsLikeTheEngineThatTheProgramReads) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  using S = typename Api::Scene;
  const auto engine = program::read_engine_file(kDiesel, {"engine", "crank", "masses"});
  const auto storage = std::make_unique<TableStorage<Real, S>>();
  ASSERT_TRUE(storage->build(engine.definition(), {}).ok());
  const auto cpp = std::make_unique<Engine<Real, S>>();
  ASSERT_TRUE(cpp->init(storage->tables()).ok());

  char errors[100];
  const File file(crankloop_engine_file_read(kDiesel, nullptr, 0, errors, sizeof errors));
  ASSERT_NE(file, nullptr) << errors;
  std::size_t size = 0;
  const crankloop_definition* definition = crankloop_engine_file_definition(file.get(), &size);
  const crankloop_options options = this->default_options();
  auto tables = std::make_unique<typename Api::Tables>();
  ASSERT_TRUE(ok(Api::tables_create(tables.get(), sizeof *tables, definition, size, &options, sizeof options)));
  const auto c = this->new_engine(*tables);
  const auto in = this->turning_input();
  Input<Real, S> cpp_in;
  static_assert(sizeof cpp_in == sizeof in);
  std::memcpy(static_cast<void*>(&cpp_in), &in, sizeof in);
  std::uint32_t edges = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const auto& out = cpp->step(cpp_in);
    ASSERT_EQ(Api::step(c.get(), &in, sizeof in), out.faults);
    ASSERT_EQ(this->torque(*c), out.torque_Nm) << tick;
    if constexpr (S::crank == CrankGiven::torque) edges += this->output(*c).trigger[1].edge_count;
  }
  if (S::crank == CrankGiven::torque) {
    EXPECT_GT(edges, 0u) << "of the wheel on the camshaft";
  }
}

TEST(CEngineFileText, IsReadFromMemoryToo) {
  EXPECT_EQ(errors_of(text_of(kDiesel)), "");
  // The size is that of the text: what is behind it is not read.
  const std::string text = text_of(kDiesel);
  char errors[1000];
  const std::string longer = text + "[nonsense]\n";
  const File file(crankloop_engine_file_read("engine.ini", longer.data(), text.size(), errors, sizeof errors));
  EXPECT_NE(file, nullptr) << errors;
}

TEST(CEngineFileText, KeepsItsDiagramsRowsAsLongAsTheFile) {
  support::TemporaryFolder folder;
  std::ofstream rows(folder / "diagram.csv");
  rows << "crank_deg,pressure_kPa\n";
  for (int deg = 0; deg < 720; deg += 10) rows << deg << "," << (deg < 180 ? 5000 - 20 * deg : 100) << "\n";
  rows.close();
  std::string text = text_of(kDiesel);
  const auto begin = text.find("[pressure]");
  text.replace(begin, text.find("[friction]") - begin, "[pressure]\nsource = angle_table\nfile = diagram.csv\n");
  char errors[1000];
  File file(
      crankloop_engine_file_read((folder / "engine.ini").c_str(), text.data(), text.size(), errors, sizeof errors));
  ASSERT_NE(file, nullptr) << errors;
  const crankloop_pressure& pressure = crankloop_engine_file_definition(file.get(), nullptr)->pressure;
  EXPECT_EQ(pressure.source, CRANKLOOP_PRESSURE_ANGLE_TABLE);
  ASSERT_EQ(pressure.point_count, 72);
  EXPECT_EQ(pressure.points[3].at, 30);
  EXPECT_EQ(pressure.points[3].pressure_Pa, 4400e3);
}

TEST(CEngineFileText, IsRefusedWithTheLinesThatTheProgramPrints) {
  const std::string text = text_of(kDiesel);
  const std::string bad =
      replaced(replaced(text, "bore_mm = 95", "bore_mm = -95"), "stroke_mm = 115", "strok_mm = 115");
  std::string expected;
  try {
    static_cast<void>(program::read_engine_text(bad, "engine.ini", {"engine", "crank", "masses"}));
  } catch (const program::InputError& error) {
    expected = error.what();
  }
  EXPECT_NE(expected.find("engine.ini:"), std::string::npos);
  EXPECT_NE(expected.find('\n'), std::string::npos) << "two errors, two lines";
  EXPECT_EQ(errors_of(bad), expected);
  EXPECT_NE(errors_of("[engine]\nname = x\n").find("[crank]"), std::string::npos);
  EXPECT_NE(errors_of("").find("engine.ini"), std::string::npos);
  EXPECT_NE(errors_of(std::string("[engine]\0", 9)).find("not a text file"), std::string::npos);

  // Cut to the room there is.
  for (const std::size_t room : {std::size_t{1}, std::size_t{9}, expected.size(), expected.size() + 1}) {
    std::string errors(room, '?');
    EXPECT_EQ(crankloop_engine_file_read("engine.ini", bad.data(), bad.size(), errors.data(), room), nullptr);
    EXPECT_EQ(std::string(errors.c_str()), expected.substr(0, room - 1));
  }
  EXPECT_EQ(crankloop_engine_file_read("engine.ini", bad.data(), bad.size(), nullptr, 77), nullptr);
}

TEST(CEngineFileText, IsRefusedWhereItsEngineBreathes) {
  std::string text = text_of(kDiesel);
  const auto begin = text.find("[pressure]");
  text.replace(begin, text.find("[friction]") - begin, "[pressure]\nsource = gas\n");
  for (const std::string name : {"intake", "exhaust"}) {
    const std::string title = "[valve " + name + "]";
    text = replaced(text, title, title + "\nport = " + name + "\nseat_diameter_mm = 35");
  }
  const std::string errors = errors_of(text);
  EXPECT_NE(errors.find("have no gas"), std::string::npos) << errors;
  EXPECT_NE(errors.find("engine.ini:"), std::string::npos);
}

TEST(CEngineFileText, IsRefusedWithoutAPathAndFreedOnceOrNever) {
  char errors[100];
  EXPECT_EQ(crankloop_engine_file_read(nullptr, "", 0, errors, sizeof errors), nullptr);
  EXPECT_STREQ(errors, "path is null");
  EXPECT_EQ(crankloop_engine_file_read("/nowhere/engine.ini", nullptr, 0, errors, sizeof errors), nullptr);
  EXPECT_NE(std::string(errors).find("/nowhere/engine.ini"), std::string::npos);
  std::size_t size = 0;
  EXPECT_EQ(crankloop_engine_file_definition(nullptr, &size), nullptr);
  EXPECT_EQ(size, sizeof(crankloop_definition));
  crankloop_engine_file_free(nullptr);
}

}  // namespace
}  // namespace crankloop::c_api::c_engine_file_test
