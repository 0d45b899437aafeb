// The plain engine, compiled with the usual flags of a user.
#include "baseline.inl"

namespace crankloop::program::bench {

template <class Real>
std::unique_ptr<PlainEngine<Real>> plain_engine_of_usual_flags(PlainPistons pistons, const PlainEngineData& data) {
  return make_plain_engine<Real>(pistons, data);
}
template std::unique_ptr<PlainEngine<float>> plain_engine_of_usual_flags<float>(PlainPistons, const PlainEngineData&);
template std::unique_ptr<PlainEngine<double>> plain_engine_of_usual_flags<double>(PlainPistons, const PlainEngineData&);

}  // namespace crankloop::program::bench
