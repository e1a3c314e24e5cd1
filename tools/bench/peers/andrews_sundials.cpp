// Integrates Andrews' mechanism with SUNDIALS: both forms with ARKODE, the KKT form also with IDA.

#include "andrews.h"
#include "arkode_runner.h"

#include <ida/ida.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>

namespace steplap::peers {
namespace {

int reduced(double, N_Vector y, N_Vector dydt, void*) {
  andrews_reduced_rates(data_of(y), data_of(dydt));
  return 0;
}

int kkt(double, N_Vector y, N_Vector dydt, void*) {
  andrews_kkt_rates(data_of(y), data_of(dydt), nullptr);
  return 0;
}

// Returns the initial absolute angles of the bodies, in the order of andrews.h, and their rates.
std::array<double, 14> start_state(AndrewsVariant variant) {
  const AndrewsAngles q = assemble_andrews(andrews_start(variant));
  return {q[0], q[0] + q[1], q[2], q[3] + q[4], q[4], q[5] + q[6], q[6]};
}

AndrewsAngles relative_angles(const double* y) { return {y[0], y[1] - y[0], y[2], y[3] - y[4], y[4], y[5] - y[6], y[6]}; }

constexpr int k_unknowns = 20; // seven angles, seven rates, six multipliers

struct IdaCounter {
  long evaluations = 0;
};

int residual(double, N_Vector y, N_Vector dydt, N_Vector out, void* counter) {
  const double* u = data_of(y);
  const double* rate = data_of(dydt);
  double* r = data_of(out);
  ++static_cast<IdaCounter*>(counter)->evaluations;
  for (int i = 0; i < 7; ++i) r[i] = rate[i] - u[7 + i];
  andrews_kkt_residual(u, rate + 7, u + 14, r + 7);
  return 0;
}

} // namespace

AndrewsResult run_andrews_arkode(AndrewsVariant variant, double tolerance) {
  std::array<double, 2> y = {andrews_start(variant), 0.0};
  ArkodeRunner runner({2, reduced}, y.data(), tolerance);
  (void)runner.advance(k_andrews_end[static_cast<int>(variant)]);
  return {assemble_andrews(y[0]), runner.steps(), runner.evaluations()};
}

AndrewsResult run_andrews_kkt_arkode(AndrewsVariant variant, double tolerance) {
  std::array<double, 14> y = start_state(variant);
  ArkodeRunner runner({14, kkt}, y.data(), tolerance);
  (void)runner.advance(k_andrews_end[static_cast<int>(variant)]);
  return {relative_angles(y.data()), runner.steps(), runner.evaluations()};
}

AndrewsResult run_andrews_kkt_ida(AndrewsVariant variant, double tolerance) {
  const SundialsContext sundials;
  std::array<double, k_unknowns> y{};
  std::array<double, k_unknowns> rate{};
  std::array<double, k_unknowns> differential{};
  const std::array<double, 14> start = start_state(variant);
  std::copy(start.begin(), start.end(), y.begin());
  std::fill(differential.begin(), differential.begin() + 14, 1.0);
  andrews_kkt_rates(y.data(), rate.data(), y.data() + 14);

  const VectorView yv(k_unknowns, y.data(), sundials.context);
  const VectorView rv(k_unknowns, rate.data(), sundials.context);
  const VectorView id(k_unknowns, differential.data(), sundials.context);
  IdaCounter counter;
  void* memory = IDACreate(sundials.context);
  require(IDAInit(memory, residual, 0.0, yv.get(), rv.get()), "IDAInit");
  require(IDASStolerances(memory, tolerance, tolerance), "IDASStolerances");
  require(IDASetUserData(memory, &counter), "IDASetUserData");
  SUNMatrix matrix = SUNDenseMatrix(k_unknowns, k_unknowns, sundials.context);
  SUNLinearSolver solver = SUNLinSol_Dense(yv.get(), matrix, sundials.context);
  require(IDASetLinearSolver(memory, solver, matrix), "IDASetLinearSolver");
  require(IDASetId(memory, id.get()), "IDASetId");
  // Excludes the multipliers from the error control, because they follow from the state.
  require(IDASetSuppressAlg(memory, SUNTRUE), "IDASetSuppressAlg");
  require(IDASetMaxNumSteps(memory, 10000000), "IDASetMaxNumSteps");
  const double end = k_andrews_end[static_cast<int>(variant)];
  require(IDASetStopTime(memory, end), "IDASetStopTime");
  double t = 0.0;
  AndrewsResult result;
  const int flag = IDASolve(memory, end, &t, yv.get(), rv.get(), IDA_NORMAL);
  result.angles = relative_angles(y.data());
  if (flag < 0) result.angles.fill(1e300); // the end was not reached
  require(IDAGetNumSteps(memory, &result.steps), "IDAGetNumSteps");
  result.evaluations = counter.evaluations;
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  IDAFree(&memory);
  return result;
}

} // namespace steplap::peers
