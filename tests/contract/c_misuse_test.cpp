// Misuse of the C interface is refused with a status: nothing is written through a null pointer, into too little room,
// or by an engine that is none.
#include "c_api.hpp"

#include <cstring>

namespace crankloop::c_api::c_misuse_test {
namespace {

TYPED_TEST_SUITE(CEngine, AllApis, ApiName);

TYPED_TEST(CEngine, RefusesMisuseInPlainWords) {
  using Api = TypeParam;
  auto tables = std::make_unique<typename Api::Tables>();
  auto engine = std::make_unique<typename Api::Engine>();
  const crankloop_definition definition = c::as_c(diesel_495());
  crankloop_options options = this->default_options();
  auto in = this->turning_input();
  auto out = std::make_unique<typename Api::Output>();
  const auto create = [&](typename Api::Tables* t, std::size_t size) {
    return Api::tables_create(t, size, &definition, sizeof definition, &options, sizeof options);
  };
  const auto faults = [&] { return Api::step(engine.get(), &in, sizeof in); };
  constexpr std::uint32_t kNotReady = CRANKLOOP_FAULT_NOT_READY;

  // Not created.
  EXPECT_TRUE(answers(Api::create(engine.get(), sizeof *engine, tables.get(), 0), CRANKLOOP_NOT_CREATED, "tables"));
  EXPECT_TRUE(answers(Api::tables_discard(tables.get()), CRANKLOOP_NOT_CREATED, "tables"));
  EXPECT_TRUE(answers(Api::reset(engine.get(), 0), CRANKLOOP_NOT_CREATED, "engine"));
  std::vector<unsigned char> saved(Api::kSavedBytes);
  EXPECT_TRUE(answers(Api::save(engine.get(), saved.data(), saved.size()), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_TRUE(answers(Api::load(engine.get(), saved.data(), saved.size()), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_TRUE(answers(Api::discard(engine.get()), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_TRUE(answers(Api::read(engine.get(), out.get(), sizeof *out), CRANKLOOP_NOT_CREATED, "engine"));
  EXPECT_EQ(faults(), kNotReady);

  // Too small, not aligned.
  EXPECT_TRUE(answers(create(tables.get(), 1000), CRANKLOOP_WRONG_SIZE, "tables"));
  auto bytes = std::make_unique<unsigned char[]>(sizeof(typename Api::Tables) + 8);
  auto* askew = reinterpret_cast<typename Api::Tables*>(bytes.get() + 4);
  EXPECT_TRUE(answers(create(askew, sizeof *tables), CRANKLOOP_MISALIGNED, "tables"));
  EXPECT_TRUE(answers(Api::tables_discard(askew), CRANKLOOP_MISALIGNED, "tables"));
  ASSERT_TRUE(ok(create(tables.get(), sizeof *tables)));
  EXPECT_TRUE(answers(Api::create(engine.get(), 100, tables.get(), 0), CRANKLOOP_WRONG_SIZE, "engine"));

  // Twice.
  EXPECT_TRUE(answers(create(tables.get(), sizeof *tables), CRANKLOOP_ALREADY_CREATED, "tables"));
  ASSERT_TRUE(ok(Api::create(engine.get(), sizeof *engine, tables.get(), 0)));
  EXPECT_TRUE(answers(Api::create(engine.get(), sizeof *engine, tables.get(), 0), CRANKLOOP_ALREADY_CREATED, "engine"));

  // Too little room; bytes of another engine.
  EXPECT_TRUE(answers(Api::save(engine.get(), saved.data(), Api::kSavedBytes - 1), CRANKLOOP_WRONG_SIZE, "state.size"));
  const auto other_tables = this->new_tables([] {
    EngineDefinition longer = diesel_495();
    longer.crank.rod_length_m = 0.220;
    return longer;
  }());
  const auto other = this->new_engine(*other_tables);
  ASSERT_TRUE(ok(Api::save(other.get(), saved.data(), saved.size())));
  EXPECT_TRUE(
      answers(Api::load(engine.get(), saved.data(), saved.size()), CRANKLOOP_OTHER_TABLES, "state.fingerprint"));

  // The tables are taken away, and others put in their place.
  ASSERT_TRUE(ok(Api::tables_discard(tables.get())));
  EXPECT_EQ(faults(), kNotReady);
  EXPECT_TRUE(answers(Api::read(engine.get(), out.get(), sizeof *out), CRANKLOOP_NOT_CREATED, "tables"));
  options.tick_s = 50e-6;
  ASSERT_TRUE(ok(create(tables.get(), sizeof *tables)));
  EXPECT_EQ(faults(), kNotReady);
  EXPECT_TRUE(answers(Api::read(engine.get(), out.get(), sizeof *out), CRANKLOOP_OTHER_TABLES, "tables"));
  ASSERT_TRUE(ok(Api::reset(engine.get(), 0)));
  EXPECT_EQ(faults(), 0u);
  ASSERT_TRUE(ok(Api::discard(engine.get())));
  EXPECT_EQ(faults(), kNotReady);
  EXPECT_TRUE(ok(Api::create(engine.get(), sizeof *engine, tables.get(), 0))) << "and its memory is free for another";
}

/// Every call with each of its pointers null in turn, whatever room it is said to have.
TYPED_TEST(CEngine, WritesNothingThroughANullPointer) {
  using Api = TypeParam;
  constexpr std::size_t kRoom = 1 << 20;
  const auto tables = this->new_tables(diesel_495());
  const auto engine = this->new_engine(*tables);
  const auto in = this->turning_input();
  ASSERT_EQ(Api::step(engine.get(), &in, sizeof in), 0u);
  const auto is_null = [](const crankloop_status& status) { return status.reason == CRANKLOOP_NULL_POINTER; };
  EXPECT_TRUE(is_null(crankloop_definition_defaults(nullptr, kRoom)));
  EXPECT_TRUE(is_null(crankloop_options_defaults(nullptr, kRoom)));
  EXPECT_TRUE(is_null(crankloop_set_firing_order(nullptr, kRoom, nullptr, 4)));
  EXPECT_TRUE(is_null(crankloop_share_pins_by_position(nullptr, kRoom)));
  crankloop_definition definition;
  ASSERT_TRUE(ok(crankloop_definition_defaults(&definition, sizeof definition)));
  EXPECT_TRUE(is_null(crankloop_set_firing_order(&definition, sizeof definition, nullptr, 4)));

  const crankloop_options options = this->default_options();
  auto free_tables = std::make_unique<typename Api::Tables>();
  auto free_engine = std::make_unique<typename Api::Engine>();
  EXPECT_TRUE(is_null(Api::tables_create(nullptr, kRoom, &definition, sizeof definition, &options, sizeof options)));
  EXPECT_TRUE(
      is_null(Api::tables_create(free_tables.get(), sizeof *free_tables, nullptr, kRoom, &options, sizeof options)));
  EXPECT_TRUE(is_null(
      Api::tables_create(free_tables.get(), sizeof *free_tables, &definition, sizeof definition, nullptr, kRoom)));
  EXPECT_TRUE(is_null(Api::tables_discard(nullptr)));
  EXPECT_TRUE(is_null(Api::create(nullptr, kRoom, tables.get(), 0)));
  EXPECT_TRUE(is_null(Api::create(free_engine.get(), sizeof *free_engine, nullptr, 0)));
  EXPECT_TRUE(is_null(Api::discard(nullptr)));
  EXPECT_TRUE(is_null(Api::reset(nullptr, 0)));
  EXPECT_TRUE(is_null(Api::input_defaults(nullptr, kRoom)));
  EXPECT_EQ(Api::step(nullptr, &in, sizeof in), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_EQ(Api::step(engine.get(), nullptr, kRoom), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  EXPECT_EQ(Api::step(engine.get(), nullptr, 0), std::uint32_t{CRANKLOOP_FAULT_NOT_READY});
  auto out = std::make_unique<typename Api::Output>();
  EXPECT_TRUE(is_null(Api::read(nullptr, out.get(), sizeof *out)));
  EXPECT_TRUE(is_null(Api::read(engine.get(), nullptr, kRoom)));
  std::vector<unsigned char> bytes(Api::kSavedBytes);
  EXPECT_TRUE(is_null(Api::save(nullptr, bytes.data(), bytes.size())));
  EXPECT_TRUE(is_null(Api::save(engine.get(), nullptr, kRoom)));
  EXPECT_TRUE(is_null(Api::load(nullptr, bytes.data(), bytes.size())));
  EXPECT_TRUE(is_null(Api::load(engine.get(), nullptr, Api::kSavedBytes)));

  std::uint32_t faults = 0;
  double value = 0;
  crankloop_column column{"torque_Nm", &value, 1, 0, nullptr, 0, 0};
  EXPECT_TRUE(is_null(Api::step_many(nullptr, 1, &column, 1, &faults)));
  EXPECT_TRUE(is_null(Api::step_many(engine.get(), 1, nullptr, 1, &faults)));
  EXPECT_TRUE(is_null(Api::step_many(engine.get(), 1, &column, 1, nullptr)));
  column.values = nullptr;
  EXPECT_TRUE(is_null(Api::step_many(engine.get(), 1, &column, 1, &faults)));
  column = {nullptr, &value, 1, 0, nullptr, 0, 0};
  EXPECT_TRUE(is_null(Api::step_many(engine.get(), 1, &column, 1, &faults)));
  EXPECT_EQ(Api::step(engine.get(), &in, sizeof in), 0u) << "and the engine goes on";
}

}  // namespace
}  // namespace crankloop::c_api::c_misuse_test
