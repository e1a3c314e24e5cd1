// Measures machine code generated from a tape: time per tape step for compilation and for execution, ns, for each instruction set of the
// processor, in comparison with interpreted replay.
//
// The tape is synthetic and resembles an evaluation: sums of products along about a dozen parallel chains, every third operand an input or
// a constant, every tenth value used again much later, 2 % divisions, one square root, one condition.
#include "mbd/tape/machine_code.h"
#include "mbd/tape/register_plan.h"

#include <benchmark/benchmark.h>

#include <random>
#include <string>

namespace steplap {
namespace {

Tape evaluation_like(int steps) {
  using enum TapeOperation;
  std::mt19937 random(1);
  const auto among = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const int inputs = 20, constants = steps / 8;
  Tape tape;
  tape.input_count = inputs;
  for (int i = 0; i < inputs; ++i) tape.steps.push_back({input, i});
  for (int i = 0; i < constants; ++i) {
    tape.steps.push_back({constant, i});
    tape.constants.push_back(0.5 + 0.001 * i);
  }
  const int given = inputs + constants;
  std::int32_t chains[12];
  for (int i = 0; i < 12; ++i) chains[i] = i;
  for (int i = 0; i < steps; ++i) {
    std::int32_t& chain = chains[among(12)];
    const auto made = static_cast<int>(tape.steps.size());
    const int p = among(100);
    const std::int32_t other = p < 30   ? among(given)
                               : p < 40 ? among(made)
                               : p < 70 ? std::max(0, made - 1 - among(12))
                                        : chains[among(12)];
    const int q = among(200);
    const TapeOperation o = q < 4 ? divide : q < 100 ? multiply : q < 160 ? add : subtract;
    tape.steps.push_back({o, chain, other});
    chain = made;
    if (q == 199) { // square roots, and conditions that are always true
      tape.steps.push_back({absolute, chain, 0});
      tape.steps.push_back({square_root, made + 1, 0});
      chain = made + 2;
    }
    if (q == 198) tape.steps.push_back({if_not_less, 0, 0});
  }
  for (int i = 0; i < 12; ++i) tape.outputs.push_back(chains[i]);
  for (int i = 0; i < 12; ++i) tape.outputs.push_back(static_cast<std::int32_t>(tape.steps.size()) - 1 - 7 * i);
  for (std::int32_t& o : tape.outputs)
    while (is_condition(tape.steps[static_cast<std::size_t>(o)].operation)) --o;
  return simplified(tape);
}

// Returns the number of executed steps: all except inputs and constants.
int count_steps(const Tape& tape) {
  int count = 0;
  for (const TapeStep& s : tape.steps) count += !is_given(s.operation);
  return count;
}

void print_per_step(benchmark::State& state, const Tape& tape) {
  const double done = static_cast<double>(state.iterations()) * count_steps(tape);
  state.counters["per_step"] = benchmark::Counter(done, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void simplify(benchmark::State& state) {
  const Tape tape = evaluation_like(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(simplified(tape));
  print_per_step(state, tape);
}

void plan(benchmark::State& state) {
  const Tape tape = evaluation_like(static_cast<int>(state.range(0)));
  RegisterRules rules;
  rules.has_three_operands = true;
  for (auto _ : state) benchmark::DoNotOptimize(plan_registers(tape, order_of_steps(tape), rules));
  print_per_step(state, tape);
}

void compile(benchmark::State& state, InstructionSet set) {
  const Tape tape = evaluation_like(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(MachineCode(tape, set));
  print_per_step(state, tape);
  const MachineCode code(tape, set);
  state.counters["instructions"] = static_cast<double>(code.instruction_count()) / count_steps(tape);
  state.counters["bytes"] = static_cast<double>(code.code_size()) / count_steps(tape);
}

void run(benchmark::State& state, InstructionSet set) {
  const Tape tape = evaluation_like(static_cast<int>(state.range(0)));
  const MachineCode code(tape, set);
  std::vector<double> inputs(static_cast<std::size_t>(tape.input_count), 0.75);
  std::vector<double> outputs(tape.outputs.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(code.run(inputs.data(), tape.constants.data(), outputs.data()));
    inputs[0] = 0.5 + 1e-3 * (outputs[0] > 0.0); // makes the next evaluation depend on this one, as between stages
    benchmark::ClobberMemory();
  }
  print_per_step(state, tape);
}

void interpret(benchmark::State& state) {
  const Tape tape = evaluation_like(static_cast<int>(state.range(0)));
  const std::vector<double> inputs(static_cast<std::size_t>(tape.input_count), 0.75);
  std::vector<double> outputs(tape.outputs.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(replay(tape, inputs.data(), tape.constants.data(), outputs.data()));
    benchmark::ClobberMemory();
  }
  print_per_step(state, tape);
}

void add_all() {
  benchmark::RegisterBenchmark("simplify", simplify)->Arg(1000);
  benchmark::RegisterBenchmark("plan", plan)->Arg(1000);
  benchmark::RegisterBenchmark("replay", interpret)->Arg(1000);
  const char* const names[] = {"sse2", "avx2", "avx512"};
  for (const InstructionSet set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512})
    if (MachineCode::is_available() && set <= MachineCode::best_instructions()) {
      const std::string name = names[static_cast<int>(set)];
      benchmark::RegisterBenchmark(("compile/" + name).c_str(), compile, set)->Arg(1000);
      benchmark::RegisterBenchmark(("run/" + name).c_str(), run, set)->Arg(1000);
    }
}

} // namespace
} // namespace steplap

int main(int argc, char** argv) {
  steplap::add_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
