#include "tests/control/qp/ipopt_qp.hpp"

#include <algorithm>
#include <cmath>

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>

namespace control::testing {
namespace {

using Ipopt::Index;
using Ipopt::Number;

class QpProblem final : public Ipopt::TNLP {
 public:
  QpProblem(const SparseQp& qp, IpoptResult& result) : qp_(qp), result_(result) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                    IndexStyleEnum& style) override {
    n = Variables();
    m = Rows();
    jacobian_entries = static_cast<Index>(qp_.A.size());
    hessian_entries = n;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* x_lo, Number* x_hi, Index m, Number* lo, Number* hi) override {
    std::fill_n(x_lo, n, -2e19);
    std::fill_n(x_hi, n, 2e19);
    for (Index i = 0; i < m; ++i) {
      lo[i] = std::max(qp_.lo[static_cast<std::size_t>(i)], -2e19);
      hi[i] = std::min(qp_.hi[static_cast<std::size_t>(i)], 2e19);
    }
    return true;
  }
  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    std::fill_n(x, n, 0.0);
    return true;
  }
  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = 0.0;
    for (Index k = 0; k < n; ++k) value += (0.5 * H(k) * x[k] + g(k)) * x[k];
    return true;
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    for (Index k = 0; k < n; ++k) gradient[k] = H(k) * x[k] + g(k);
    return true;
  }
  bool eval_g(Index, const Number* x, bool, Index m, Number* value) override {
    std::fill_n(value, m, 0.0);
    for (const auto& entry : qp_.A) value[entry.row] += entry.value * x[entry.column];
    return true;
  }
  bool eval_jac_g(Index, const Number*, bool, Index, Index, Index* row, Index* column,
                  Number* value) override {
    for (std::size_t k = 0; k < qp_.A.size(); ++k) {
      if (value == nullptr) {
        row[k] = qp_.A[k].row;
        column[k] = qp_.A[k].column;
      } else {
        value[k] = qp_.A[k].value;
      }
    }
    return true;
  }
  bool eval_h(Index n, const Number*, bool, Number factor, Index, const Number*, bool, Index, Index* row,
              Index* column, Number* value) override {
    for (Index k = 0; k < n; ++k) {
      if (value == nullptr) {
        row[k] = column[k] = k;
      } else {
        value[k] = factor * H(k);
      }
    }
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn status, Index n, const Number* x, const Number*, const Number*,
                         Index, const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    result_.solved = status == Ipopt::SUCCESS || status == Ipopt::STOP_AT_ACCEPTABLE_POINT;
    result_.x.assign(x, x + n);
  }

 private:
  [[nodiscard]] Index Variables() const { return static_cast<Index>(qp_.H.size()); }
  [[nodiscard]] Index Rows() const { return static_cast<Index>(qp_.lo.size()); }
  [[nodiscard]] double H(Index k) const { return qp_.H[static_cast<std::size_t>(k)]; }
  [[nodiscard]] double g(Index k) const { return qp_.g[static_cast<std::size_t>(k)]; }

  const SparseQp& qp_;
  IpoptResult& result_;
};

}  // namespace

IpoptResult SolveWithIpopt(const SparseQp& qp) {
  IpoptResult result;
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> app = IpoptApplicationFactory();
  app->Options()->SetIntegerValue("print_level", 0);
  app->Options()->SetStringValue("sb", "yes");
  app->Options()->SetStringValue("linear_solver", "mumps");
  app->Options()->SetNumericValue("tol", 1e-10);
  app->Options()->SetNumericValue("bound_relax_factor", 0.0);
  app->Options()->SetStringValue("jac_c_constant", "yes");
  app->Options()->SetStringValue("jac_d_constant", "yes");
  app->Options()->SetStringValue("hessian_constant", "yes");
  if (app->Initialize() != Ipopt::Solve_Succeeded) return result;
  const Ipopt::SmartPtr<Ipopt::TNLP> problem = new QpProblem(qp, result);
  (void)app->OptimizeTNLP(problem);
  return result;
}

}  // namespace control::testing
