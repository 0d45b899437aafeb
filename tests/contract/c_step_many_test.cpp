// step_many() runs an engine over arrays: what single steps give, for every name of the list of variables, and refuses
// columns that it cannot fill before it steps.
#include "c_api.hpp"

#include <cmath>
#include <cstring>
#include <set>

#include <crankloop/variables.hpp>

namespace crankloop::c_api::c_step_many_test {
namespace {

TYPED_TEST_SUITE(CEngine, AllApis, ApiName);

crankloop_column column(const char* name, std::vector<double>& values, std::size_t stride = 1) {
  return {name, values.data(), values.size(), stride, nullptr, 0, 0};
}

/// "valve[#,#].lift_m" with its indices, from 1.
std::string written(const detail::Variable& variable) {
  std::string name = variable.name;
  for (const std::uint32_t index : {variable.first, variable.second}) {
    if (const auto at = name.find('#'); at != std::string::npos) name.replace(at, 1, std::to_string(index + 1));
  }
  return name;
}

/// Numbers as step_many gives them.
double number(Phase phase) { return static_cast<double>(phase.units()) * 0x1p-64 * 720; }
double number(double x) { return x; }
double number(float x) { return static_cast<double>(x); }
double number(std::uint32_t x) { return x; }

TYPED_TEST(CEngine, GivesInColumnsWhatSingleStepsGiveForEveryOutputOfTheList) {
  using Api = TypeParam;
  using Real = typename Api::Real;
  using S = typename Api::Scene;
  constexpr int kTicks = 400;
  constexpr std::uint64_t kStart = 0x3F00'0000'0000'0000;  // 177 deg: before an edge of the wheel on the camshaft
  const EngineDefinition definition = diesel_495();
  const auto tables = this->new_tables(definition);
  const auto engine = this->new_engine(*tables, kStart);
  const auto storage = std::make_unique<TableStorage<Real, S>>();
  ASSERT_TRUE(storage->build(definition, {}).ok());
  const auto cpp = std::make_unique<Engine<Real, S>>();
  ASSERT_TRUE(cpp->init(storage->tables(), Phase{kStart}).ok());

  // Inputs: one that changes, one that stays, one that the engine refuses in one tick.
  std::vector<double> load_ratio(kTicks);
  for (int tick = 0; tick < kTicks; ++tick) load_ratio[static_cast<std::size_t>(tick)] = tick % 5 * 0.25;
  load_ratio[200] = 1e300;  // float cannot hold it
  std::vector<double> drive = {Api::Scene::crank == CrankGiven::speed ? 300.0 : 1.0};
  std::vector<crankloop_column> columns = {
      column("load_ratio", load_ratio),
      column(Api::Scene::crank == CrankGiven::speed ? "speed_rad_s" : "starter", drive, 0)};

  std::vector<std::string> names = {"faults"};
  const auto list = [&names](const detail::Variable& variable, const auto&) { names.push_back(written(variable)); };
  const detail::EngineShape shape = detail::shape_of<Real, S>(storage->tables());
  detail::each_output<S>(list, cpp->state(), cpp->output(), shape);
  detail::each_event<S>(list, cpp->output(), shape);
  ASSERT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << "names are unique";
  std::vector<std::vector<double>> outputs(names.size(), std::vector<double>(kTicks, -1.0));
  for (std::size_t i = 0; i < names.size(); ++i) columns.push_back(column(names[i].c_str(), outputs[i]));

  std::uint32_t faults = 0;
  ASSERT_TRUE(ok(Api::step_many(engine.get(), kTicks, columns.data(), columns.size(), &faults)));
  std::uint32_t expected_faults = 0;
  for (std::size_t tick = 0; tick < kTicks; ++tick) {
    Input<Real, S> in;
    in.load_ratio = tick == 200 ? Real{-1} : static_cast<Real>(load_ratio[tick]);
    if constexpr (Api::Scene::crank == CrankGiven::speed) {
      in.speed_rad_s = 300;
    } else {
      in.starter = 1;
    }
    const auto& out = cpp->step(in);
    expected_faults |= out.faults;
    ASSERT_EQ(outputs[0][tick], out.faults);
    std::size_t i = 1;
    const auto compare = [&](const detail::Variable& variable, const auto& value) {
      const double want = number(value);
      const double largest = std::string(variable.name) == "crank_deg" ? 720 * 0x1p-52 : 0;  // its rounding
      ASSERT_NEAR(outputs[i][tick], want, largest) << names[i] << ", tick " << tick;
      ++i;
    };
    detail::each_output<S>(compare, cpp->state(), out, shape);
    detail::each_event<S>(compare, out, shape);
    ASSERT_EQ(i, names.size());
  }
  EXPECT_EQ(faults, expected_faults);
  EXPECT_EQ(faults, std::uint32_t{CRANKLOOP_FAULT_LOAD_RATIO});
  // Numbers that are not what an empty column would have.
  std::set<std::string> changing;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const double x : outputs[i]) {
      if (x != outputs[i][0]) changing.insert(names[i]);
    }
  }
  EXPECT_EQ(changing.count("torque_Nm") + changing.count("crank_deg") + changing.count("faults"), 3u);
  if (shape.wheels > 0) {
    EXPECT_EQ(changing.count("trigger[1].edge_count") + changing.count("trigger[2].level"), 2u);
  }
}

TYPED_TEST(CEngine, TakesColumnsOfATableRowByRow) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto one = this->new_engine(*tables);
  const auto other = this->new_engine(*tables);
  std::vector<double> drive = {Api::Scene::crank == CrankGiven::speed ? 200.0 : 1.0};
  const char* given = Api::Scene::crank == CrankGiven::speed ? "speed_rad_s" : "starter";
  constexpr std::size_t kTicks = 50;
  std::vector<double> torque(kTicks), mean(kTicks), both(2 * kTicks);
  crankloop_column apart[] = {column(given, drive, 0), column("torque_Nm", torque), column("mean_torque_Nm", mean)};
  crankloop_column together[] = {column(given, drive, 0),
                                 column("torque_Nm", both, 2),
                                 {"mean_torque_Nm", &both[1], both.size() - 1, 2, nullptr, 0, 0}};
  std::uint32_t faults = 1;
  ASSERT_TRUE(ok(Api::step_many(one.get(), kTicks, apart, 3, &faults)));
  EXPECT_EQ(faults, 0u);
  ASSERT_TRUE(ok(Api::step_many(other.get(), kTicks, together, 3, &faults)));
  for (std::size_t tick = 0; tick < kTicks; ++tick) {
    ASSERT_EQ(both[2 * tick], torque[tick]);
    ASSERT_EQ(both[2 * tick + 1], mean[tick]);
  }
  EXPECT_NE(torque.front(), torque.back());
}

TYPED_TEST(CEngine, RefusesAColumnThatItCannotFillBeforeItSteps) {
  using Api = TypeParam;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  const auto before = this->output(*engine);
  std::vector<double> values(100, 7.0);
  std::uint32_t faults = 0;
  const auto refuses = [&](crankloop_column bad, std::size_t ticks, int reason, const char* field) {
    crankloop_column columns[] = {column("torque_Nm", values, 0), bad};
    const crankloop_status status = Api::step_many(engine.get(), ticks, columns, 2, &faults);
    EXPECT_EQ(status.index, 1) << "the second column";
    return answers(status, reason, field);
  };
  const auto unknown = [&](const char* name) {
    return refuses(column(name, values), 100, CRANKLOOP_UNKNOWN_NAME, "columns.name");
  };
  // No such name, no such cylinder of this engine, counted from 0, cut short, too long, not of this scene.
  for (const char* name : {"", "torque", "torque_Nmm", "Torque_Nm", "torque_Nm[1]", "valve[3,1].lift_m", "#",
                           "cylinder[5].pressure_Pa", "cylinder[0].pressure_Pa", "cylinder[01].pressure_Pa",
                           "trigger[3].level", "trigger[1].edge[33].level", "pressure_Pa[1]"}) {
    EXPECT_TRUE(unknown(name)) << name;
  }
  EXPECT_TRUE(refuses(column("mean_torque_Nm", values), 101, CRANKLOOP_WRONG_SIZE, "columns.count"));
  EXPECT_TRUE(refuses(column("mean_torque_Nm", values, 2), 51, CRANKLOOP_WRONG_SIZE, "columns.count"));
  EXPECT_TRUE(refuses(column("mean_torque_Nm", values, SIZE_MAX), 3, CRANKLOOP_WRONG_SIZE, "columns.count"));
  crankloop_column none = column("mean_torque_Nm", values, 0);
  none.count = 0;
  EXPECT_TRUE(refuses(none, 1, CRANKLOOP_WRONG_SIZE, "columns.count"));
  for (const double x : values) EXPECT_EQ(x, 7.0);
  EXPECT_EQ(this->output(*engine).crank, before.crank);

  // What just fits does.
  crankloop_column fits[] = {column("torque_Nm", values), column("mean_torque_Nm", values, 0)};
  EXPECT_TRUE(ok(Api::step_many(engine.get(), 100, fits, 2, &faults)));
  EXPECT_TRUE(ok(Api::step_many(engine.get(), 0, fits, 2, &faults)));
  EXPECT_TRUE(ok(Api::step_many(engine.get(), 5, nullptr, 0, &faults)));
}

}  // namespace
}  // namespace crankloop::c_api::c_step_many_test
