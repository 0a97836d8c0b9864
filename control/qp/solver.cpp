#include "control/qp/solver.hpp"

#include "control/qp/kkt.hpp"

namespace control {

template struct OcpQpStage<8, 2>;
template KktResidual EvaluateKkt(const OcpQp<8, 2>&, const OcpQpPoint<8, 2>&);
template double EvaluateCost(const OcpQp<8, 2>&, const OcpQpPoint<8, 2>&);
template bool ProvesInfeasible(const OcpQp<8, 2>&, const OcpQpPoint<8, 2>&);
template class OcpQpSolver<8, 2>;

template struct OcpQpStage<2, 1>;
template class OcpQpSolver<2, 1>;

}  // namespace control
