// A firmware that prints why its engine was refused, by the C interface alone.
#include "port/common/machine.hpp"
#include "port/common/text.hpp"
#include "refused_engine.h"

int main() {
  static refused_engine_engine engine;
  const crankloop_status status = refused_engine_create(&engine, sizeof engine - 1, 0);
  char text[80];
  crankloop_status_text(status, text, sizeof text);
  crankloop::port::Line() << text;
  const bool refused = status.reason == CRANKLOOP_WRONG_SIZE && refused_engine_step(&engine, nullptr, 0) != 0;
  crankloop::port::finish(refused ? 0 : 1);
}
