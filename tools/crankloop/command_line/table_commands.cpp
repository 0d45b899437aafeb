#include "commands.hpp"

namespace crankloop::program {

const std::vector<const Command*>& commands() {
  static const std::vector<const Command*> all = {&kTables, &kPack};
  return all;
}

}  // namespace crankloop::program
