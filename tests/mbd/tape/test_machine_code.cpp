// Machine code against replay, to the bit, for every set of instructions that the processor has, and sines side by side.
#include "mbd/base/portable_math.h"
#include "mbd/tape/machine_code.h"
#include "mbd/tape/sine_lanes.h"
#include "random_tape.h"
#include "same_bits.h"

#include <doctest/doctest.h>

#ifdef __linux__
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>

using namespace steplap;
using namespace steplap::testing;
using enum TapeOperation;

namespace {

constexpr double k_untouched = 1234.5;

std::vector<InstructionSet> all_sets() {
  std::vector<InstructionSet> sets;
  if (!MachineCode::is_available()) return sets;
  for (const InstructionSet set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512})
    if (set <= MachineCode::best_instructions()) sets.push_back(set);
  return sets;
}

/// Numbers of several samples, and what replay makes of them.
struct Samples {
  std::vector<std::vector<double>> inputs, constants, outputs;
  std::vector<bool> holds;

  void add(const Tape& tape, std::vector<double> in, std::vector<double> con) {
    outputs.emplace_back(tape.outputs.size(), k_untouched);
    holds.push_back(replay(tape, in.data(), con.data(), outputs.back().data()));
    inputs.push_back(std::move(in));
    constants.push_back(std::move(con));
  }
};

// What differs, "" if nothing does.
std::string difference(const MachineCode& code, const Samples& samples, std::size_t sample) {
  std::vector<double> outputs(samples.outputs[sample].size(), k_untouched);
  if (code.run(samples.inputs[sample].data(), samples.constants[sample].data(), outputs.data()) != samples.holds[sample])
    return "a condition";
  for (std::size_t k = 0; k < outputs.size(); ++k)
    if (!are_same_bits(outputs[k], samples.outputs[sample][k])) return "output " + std::to_string(k);
  return "";
}

void check_everywhere(const Tape& tape, const Samples& samples) {
  for (const InstructionSet set : all_sets()) {
    const MachineCode code(tape, set);
    REQUIRE(code);
    std::string found;
    for (std::size_t i = 0; i < samples.holds.size() && found.empty(); ++i) found = difference(code, samples, i);
    CHECK_MESSAGE(found.empty(), found << ", instructions " << static_cast<int>(set));
  }
}

Samples random_samples(std::mt19937& random, const Tape& tape, int count, bool has_special) {
  Samples samples;
  for (int i = 0; i < count; ++i)
    samples.add(tape, random_numbers(random, tape.input_count, has_special), random_constants(random, tape, has_special));
  return samples;
}

// Conditions turned so that they hold for the numbers.
Tape holding(Tape tape, const std::vector<double>& inputs, const std::vector<double>& constants) {
  std::vector<double> nothing;
  Tape part{{}, tape.constants, tape.input_count, {}};
  for (TapeStep& s : tape.steps) {
    part.steps.push_back(s);
    if (!is_condition(s.operation) || replay(part, inputs.data(), constants.data(), nothing.data())) continue;
    s.operation = s.operation == if_less ? if_not_less : if_less;
    part.steps.back() = s;
  }
  return tape;
}

// Pages of memory that may be executed and belong to no file.
int executable_mappings() {
  std::ifstream maps("/proc/self/maps");
  int count = 0;
  for (std::string line; std::getline(maps, line);)
    count += line.find('x') < line.find(' ', line.find(' ') + 1) && line.find('/') == std::string::npos;
  return count;
}

} // namespace

TEST_CASE("random tapes, as they are and simplified") {
  std::mt19937 random(14);
  int held = 0, failed = 0;
  for (int i = 0; i < 600; ++i) {
    TapeShape shape;
    shape.steps = i < 200 ? 1 + i % 40 : 20 + i;
    shape.inputs = i % 3 == 0 ? 3 : 25;
    shape.constants = i % 5 == 0 ? 0 : 30;
    shape.reach = i % 4 == 0 ? 4 : i % 4 == 1 ? 40 : i % 4 == 2 ? 300 : 12;
    shape.outputs = 1 + i % 60;
    shape.conditions = i % 2 == 0 ? 0.0 : 2.0 / shape.steps;
    shape.calls = i % 7 == 0 ? 0.1 : 0.01;
    const Tape tape = random_tape(random, shape);
    const Samples samples = random_samples(random, tape, 9, i % 3 != 0);
    for (const bool holds : samples.holds) (holds ? held : failed) += 1;
    CAPTURE(i);
    check_everywhere(tape, samples);
    check_everywhere(simplified(tape), samples);
  }
  CHECK(held > 1000);
  CHECK(failed > 500);
}

TEST_CASE("random tapes that call functions, as they are and simplified") {
  std::mt19937 random(15);
  for (int i = 0; i < 200; ++i) {
    TapeShape shape;
    shape.steps = 5 + i;
    shape.reach = i % 3 == 0 ? 4 : 100;
    shape.outputs = 1 + i % 40;
    shape.conditions = i % 2 == 0 ? 0.0 : 0.5 / shape.steps;
    shape.calls = i % 4 == 0 ? 0.05 : 0.0;
    shape.functions = i % 5 == 0 ? 0.3 : 0.04;
    Tape tape = random_tape(random, shape);
    std::sort(tape.outputs.begin(), tape.outputs.end());
    if (i % 3 == 1) tape.usual_outputs = tape.outputs.size() / 2;
    const Samples samples = random_samples(random, tape, 6, i % 2 == 0);
    CAPTURE(i);
    check_everywhere(tape, samples);
    check_everywhere(simplified(tape), samples);
  }
}

TEST_CASE("the usual outputs alone, where no more is wanted") {
  if (!MachineCode::is_available()) return;
  std::mt19937 random(21);
  int left_out = 0;
  for (int i = 0; i < 200; ++i) {
    TapeShape shape;
    shape.steps = 30 + i;
    shape.reach = i % 2 == 0 ? 10 : 200;
    shape.outputs = 2 + i % 30;
    shape.conditions = i % 3 == 0 ? 0.02 : 0.0;
    shape.calls = i % 5 == 0 ? 0.05 : 0.0;
    Tape drawn = random_tape(random, shape);
    std::sort(drawn.outputs.begin(), drawn.outputs.end()); // as they are in use: what is seldom wanted is found last
    drawn.usual_outputs = 1 + static_cast<std::size_t>(i) % (drawn.outputs.size() - 1);
    const Tape tape = simplified(drawn);
    CHECK(tape.usual_outputs == drawn.usual_outputs);
    const Samples samples = random_samples(random, tape, 8, true);
    CAPTURE(i);
    check_everywhere(tape, samples);
    for (const InstructionSet set : all_sets()) {
      const MachineCode code(tape, set);
      for (std::size_t sample = 0; sample < samples.holds.size(); ++sample) {
        std::vector<double> outputs(tape.outputs.size(), k_untouched);
        CHECK(code.run(samples.inputs[sample].data(), samples.constants[sample].data(), outputs.data(), false) == samples.holds[sample]);
        for (std::size_t k = 0; k < tape.usual_outputs && samples.holds[sample]; ++k)
          CHECK(are_same_bits(outputs[k], samples.outputs[sample][k]));
        if (samples.holds[sample] && outputs.back() == k_untouched) ++left_out;
      }
    }
  }
  CHECK(left_out > 100); // something was saved
}

TEST_CASE("inputs and outputs in arrays of their own") {
  std::mt19937 random(17);
  for (int i = 0; i < 150; ++i) {
    TapeShape shape;
    shape.steps = 20 + 4 * i;
    shape.outputs = 30;
    shape.calls = i % 3 == 0 ? 0.03 : 0.0; // behind a call the arrays are looked up anew
    shape.functions = i % 5 == 0 ? 0.03 : 0.0;
    shape.conditions = i % 2 == 0 ? 0.0 : 0.5 / shape.steps;
    Tape tape = random_tape(random, shape);
    tape.usual_outputs = i % 4 == 0 ? 12 : 0;
    const Samples samples = random_samples(random, tape, 4, i % 2 == 0);
    tape.first_inputs = 1 + i % (tape.input_count - 1);
    // Each array has more room than outputs, which lie in it in an order of their own.
    constexpr std::size_t k_room = 40;
    std::vector<std::int32_t> order(k_room);
    for (std::size_t p = 0; p < k_room; ++p) order[p] = static_cast<std::int32_t>(p);
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t k = 0; k < tape.outputs.size(); ++k)
      tape.places.push_back({static_cast<std::int32_t>(random() % (CodeArrays::k_more + 1)), order[k]});
    CAPTURE(i);
    for (const InstructionSet set : all_sets()) {
      const MachineCode code(simplified(tape), set);
      REQUIRE(code);
      for (std::size_t n = 0; n < samples.holds.size(); ++n) {
        std::vector<std::vector<double>> found(CodeArrays::k_more + 1, std::vector<double>(k_room, k_untouched));
        const std::vector<double>& in = samples.inputs[n];
        const std::vector<double> first(in.begin(), in.begin() + tape.first_inputs), later(in.begin() + tape.first_inputs, in.end());
        const CodeArrays arrays{samples.constants[n].data(), later.data(), {found[1].data(), found[2].data(), found[3].data()}};
        REQUIRE(code.run(first.data(), arrays, found[0].data(), true) == samples.holds[n]);
        std::size_t written = 0;
        for (const std::vector<double>& array : found)
          written += k_room - static_cast<std::size_t>(std::count(array.begin(), array.end(), k_untouched));
        CHECK(written == (samples.holds[n] ? tape.outputs.size() : 0));
        for (std::size_t k = 0; k < tape.outputs.size(); ++k)
          CHECK(are_same_bits(found[static_cast<std::size_t>(tape.places[k].array)][static_cast<std::size_t>(tape.places[k].place)],
                              samples.outputs[n][k]));
      }
    }
  }
}

TEST_CASE("many more live values than registers") {
  // sums of products of all pairs: x₀ x₁ + x₁ x₂ + …, then taken apart from the other end
  const int n = 200;
  std::mt19937 random(3);
  Tape tape;
  tape.input_count = n;
  for (int i = 0; i < n; ++i) tape.steps.push_back({input, i});
  for (int i = 0; i < n; ++i) tape.steps.push_back({i % 3 == 0 ? square_root : i % 3 == 1 ? negate : absolute, i});
  for (int i = 0; i < n; ++i) tape.steps.push_back({i % 2 == 0 ? subtract : divide, n + i, 2 * n - 1 - i});
  for (int i = 0; i < n; ++i) tape.outputs.push_back(2 * n + i);
  check_everywhere(tape, random_samples(random, tape, 9, true));
}

TEST_CASE("a condition that fails first, in the middle, last leaves the outputs alone") {
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    TapeShape shape;
    shape.conditions = 0.05;
    shape.reach = i % 2 == 0 ? 8 : 150;
    shape.outputs = 40;
    const Tape drawn = random_tape(random, shape);
    const auto inputs = random_numbers(random, drawn.input_count, false),
               constants = random_numbers(random, static_cast<int>(drawn.constants.size()), false);
    const Tape tape = holding(drawn, inputs, constants);
    Samples samples;
    samples.add(tape, inputs, constants);
    CHECK(samples.holds.front());
    check_everywhere(tape, samples);
    std::vector<std::size_t> conditions;
    for (std::size_t s = 0; s < tape.steps.size(); ++s)
      if (is_condition(tape.steps[s].operation)) conditions.push_back(s);
    if (conditions.empty()) continue;
    for (const std::size_t which : {conditions.front(), conditions[conditions.size() / 2], conditions.back()}) {
      Tape failing = tape;
      TapeOperation& o = failing.steps[which].operation;
      o = o == if_less ? if_not_less : if_less;
      Samples once;
      once.add(failing, inputs, constants);
      CHECK(!once.holds.front());
      check_everywhere(failing, once);
    }
  }
}

TEST_CASE("conditions with NaN, equal numbers, zeros of two signs") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const TapeOperation o : {if_less, if_not_less}) {
    const Tape tape{{{input, 0}, {input, 1}, {add, 0, 0}, {o, 0, 1}, {o, 2, 2}}, {}, 2, {2}};
    Samples samples;
    for (const double a : {1.0, 2.0, nan, 0.0, -0.0})
      for (const double b : {1.0, 2.0, nan, 0.0, -0.0}) samples.add(tape, {a, b}, {});
    check_everywhere(tape, samples);
    const Tape reversed{{{input, 0}, {input, 1}, {subtract, 1, 0}, {o, 1, 2}}, {}, 2, {1, 2}};
    Samples others;
    for (const double a : {1.0, 2.0, nan, 0.0, -0.0})
      for (const double b : {1.0, 2.0, nan, 0.0, -0.0}) others.add(reversed, {a, b}, {});
    check_everywhere(reversed, others);
  }
}

TEST_CASE("sines and cosines in the midst of what is live") {
  using Steps = std::vector<TapeStep>;
  Steps steps;
  const int n = 40;
  for (int i = 0; i < n; ++i) steps.push_back({input, i});
  for (int i = 0; i < n; ++i) steps.push_back({multiply, i, (i + 1) % n});
  // each sine of a sum that hangs on the sine before it
  std::int32_t last = n;
  std::vector<std::int32_t> outputs;
  for (int i = 0; i < 30; ++i) {
    const auto next = static_cast<std::int32_t>(steps.size());
    steps.push_back({add, last, n + i});
    steps.push_back({i % 3 == 0 ? cosine : sine, next});
    if (i % 3 != 1) steps.push_back({i % 3 == 0 ? sine : cosine, next});
    last = static_cast<std::int32_t>(steps.size()) - 1;
    if (i % 4 == 0) outputs.push_back(last - 1);
    if (i % 5 == 0) steps.push_back({if_less, last, n + (i + 7) % n});
  }
  for (int i = 0; i < n; ++i) steps.push_back({add, last, n + i}), outputs.push_back(static_cast<std::int32_t>(steps.size()) - 1);
  const Tape drawn{steps, {}, n, outputs};
  std::mt19937 random(8);
  const auto inputs = random_numbers(random, n, false);
  const Tape tape = holding(drawn, inputs, {});
  Samples samples = random_samples(random, tape, 9, true);
  samples.add(tape, inputs, {});
  for (int i = 0; i < 6; ++i) {
    auto far = random_numbers(random, n, false);
    for (double& x : far) x *= 1e8;
    samples.add(tape, far, {});
  }
  check_everywhere(tape, samples);
  check_everywhere(simplified(tape), samples);
}

TEST_CASE("sine and cosine of one argument, once, twice, one of them unwanted") {
  const Tape tapes[] = {{{{input, 0}, {sine, 0}}, {}, 1, {1}},
                        {{{input, 0}, {cosine, 0}}, {}, 1, {1, 1}},
                        {{{input, 0}, {cosine, 0}, {sine, 0}}, {}, 1, {2, 1}},
                        {{{input, 0}, {sine, 0}, {cosine, 0}, {cosine, 0}, {sine, 0}}, {}, 1, {1, 2, 3, 4}},
                        {{{input, 0}, {sine, 0}, {cosine, 0}, {add, 1, 1}}, {}, 1, {3}},
                        {{{input, 0}, {sine, 0}, {sine, 1}, {cosine, 1}, {cosine, 0}, {multiply, 4, 3}}, {}, 1, {5, 2, 1, 0}}};
  for (const Tape& tape : tapes) {
    Samples samples;
    for (const double x : {0.3, -0.0, 2.0, 1e9, -1e-300, std::numeric_limits<double>::infinity()}) samples.add(tape, {x}, {});
    check_everywhere(tape, samples);
  }
}

// Waves take theirs eight at a time, by code of its own for each set of instructions.
TEST_CASE("sines of all sizes side by side have the bits of portable::sin_cos") {
  std::mt19937 random(9);
  const auto in = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  std::vector<double> all;
  for (int i = 0; i < 4000; ++i) {
    double x = in(-0.9, 0.9);
    if (i % 4 == 1) x = in(-20.0, 20.0);
    if (i % 4 == 2) x = std::round(in(-6e5, 6e5)) * 1.5707963267948966; // where most digits cancel
    if (i % 4 == 3) x = std::ldexp(in(-1.0, 1.0), static_cast<int>(in(-1060.0, 19.9)));
    if (i >= 2000 && i % 4 != 1) x = in(-0.78, 0.78) * (i % 3); // groups that are small throughout
    if (i >= 3800 && i % 5 == 0) x = in(-1e9, 1e9);
    all.push_back(x);
  }
  for (const double edge :
       {0.78539816339744828, 0x1p-28, 1e6, 0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    for (const double x : {edge, -edge, std::nextafter(edge, 0.0), std::nextafter(edge, 1e7)}) all.push_back(x);
  REQUIRE(all.size() % 8 == 0);
  struct SineKernel {
    int count;
    void (*sin_cos)(const double*, double*, double*);
  };
  std::vector<SineKernel> ways{{8, sin_cos_of_block}};
  if (MachineCode::is_available()) ways.push_back({2, sin_cos_of_two});
  if (MachineCode::best_instructions() >= InstructionSet::avx2) ways.push_back({4, sin_cos_of_four});
  if (MachineCode::best_instructions() >= InstructionSet::avx512) ways.push_back({8, sin_cos_of_eight});
  for (const SineKernel& way : ways) {
    CAPTURE(way.count);
    int wrong = 0;
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(way.count)) {
      double sines[8], cosines[8];
      way.sin_cos(&all[i], sines, cosines);
      for (int l = 0; l < way.count; ++l) {
        const portable::SinCos of = portable::sin_cos(all[i + static_cast<std::size_t>(l)]);
        wrong += !are_same_bits(sines[l], of.sin) || !are_same_bits(cosines[l], of.cos);
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("nothing, given numbers as outputs, the same output twice") {
  const Tape tapes[] = {{},
                        {{{input, 0}, {constant, 0}}, {0.0}, 1, {0, 1, 0, 1, 1}},
                        {{{input, 0}, {constant, 0}, {subtract, 1, 0}, {negate, 2}}, {0.0}, 1, {2, 2, 3, 0, 3, 2}},
                        {{{input, 0}, {constant, 0}, {if_less, 0, 1}}, {0.0}, 1, {}},
                        {{{input, 0}, {constant, 0}, {if_less, 0, 1}, {negate, 0}, {add, 3, 3}}, {0.0}, 1, {3, 4, 0, 3}}};
  for (const Tape& tape : tapes) {
    Samples samples;
    for (const double x : {1.0, -2.0, 0.5})
      samples.add(tape, std::vector<double>(static_cast<std::size_t>(tape.input_count), x),
                  std::vector<double>(tape.constants.size(), 0.75));
    check_everywhere(tape, samples);
    check_everywhere(simplified(tape), samples);
  }
}

TEST_CASE("compiled objects are freed and can be moved") {
  if (!MachineCode::is_available()) return;
  const Tape tape{{{input, 0}, {add, 0, 0}}, {}, 1, {1}};
  const int before = executable_mappings();
  double x = 21.0, y = 0.0;
  for (int i = 0; i < 3000; ++i) {
    MachineCode first(tape);
    MachineCode second(std::move(first)), third;
    CHECK(!first);
    third = std::move(second);
    CHECK(!second);
    CHECK(third.run(&x, nullptr, &y));
  }
  CHECK(y == 42.0);
  CHECK(executable_mappings() == before);
  std::vector<MachineCode> kept;
  for (int i = 0; i < 500; ++i) kept.emplace_back(tape);
  y = 0.0;
  for (const MachineCode& code : kept) CHECK(code.run(&x, nullptr, &y));
  CHECK(executable_mappings() > before);
  kept.clear();
  CHECK(executable_mappings() == before);
}

#ifdef __linux__
// What a system of its own (systemd's MemoryDenyWriteExecute=) does to a service, done to a child: pages that could be written
// may never be executed.
TEST_CASE("where written pages may not be executed there is code all the same") {
  if (!MachineCode::is_available()) return;
  constexpr int k_deny_write_execute = 65, k_denies = 77; // PR_SET_MDWE since Linux 6.3
  const Tape tape{{{input, 0}, {add, 0, 0}}, {}, 1, {1}};
  const pid_t child = fork();
  if (child == 0) {
    if (prctl(k_deny_write_execute, 1, 0, 0, 0) != 0) _exit(k_denies);
    const MachineCode code(tape);
    double x = 21.0, y = 0.0;
    _exit(code && code.run(&x, nullptr, &y) && y == 42.0 ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == k_denies) MESSAGE("skipped: this system cannot be told to deny it");
  else CHECK(WEXITSTATUS(status) == 0);
}
#endif

TEST_CASE("instructions that there are not are refused") {
  CHECK(!MachineCode());
  if (!MachineCode::is_available()) {
    CHECK(!MachineCode(Tape{}));
    return;
  }
  const auto beyond = static_cast<InstructionSet>(static_cast<int>(MachineCode::best_instructions()) + 1);
  CHECK_THROWS_AS(MachineCode(Tape{}, beyond), std::invalid_argument);
}

// All of n + 1 values are wanted again once they are all known, in the other order.
static Tape tape_with_many_live(int n) {
  Tape tape;
  tape.input_count = 1;
  tape.steps.push_back({input, 0});
  for (int i = 0; i < n; ++i) tape.steps.push_back({add, i, 0});
  std::int32_t sum = n;
  for (int i = n - 1; i > 0; --i) tape.steps.push_back({add, sum, i}), sum = static_cast<std::int32_t>(tape.steps.size()) - 1;
  tape.outputs = {sum};
  return tape;
}

TEST_CASE("a frame of many pages; more values than it takes: no code, and no harm") {
  if (!MachineCode::is_available()) return;
  const Tape large = tape_with_many_live(3000);
  Samples samples;
  for (const double x : {1.0, 0.1, -3.0}) samples.add(large, {x}, {});
  check_everywhere(large, samples);
  const MachineCode none(tape_with_many_live(40000));
  CHECK(!none);
}
