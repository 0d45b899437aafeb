// The plain engine, compiled with the flags of everything else.
#include "baseline.inl"

namespace crankloop::program::bench {

template <class Real>
std::unique_ptr<PlainEngine<Real>> plain_engine(PlainPistons pistons, const PlainEngineData& data) {
  return make_plain_engine<Real>(pistons, data);
}
template std::unique_ptr<PlainEngine<float>> plain_engine<float>(PlainPistons, const PlainEngineData&);
template std::unique_ptr<PlainEngine<double>> plain_engine<double>(PlainPistons, const PlainEngineData&);

}  // namespace crankloop::program::bench
