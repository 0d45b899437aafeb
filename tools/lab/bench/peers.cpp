#include "peers.hpp"

namespace crankloop::program::bench {

std::vector<Peer> peers() {
  std::vector<Peer> all;
#ifdef CRANKLOOP_BENCH_ODEINT
  add_odeint(all);
#endif
#ifdef CRANKLOOP_BENCH_GSL
  add_gsl(all);
#endif
  return all;
}

}  // namespace crankloop::program::bench
