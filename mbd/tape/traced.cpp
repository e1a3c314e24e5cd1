#include "mbd/tape/traced.h"

#include <algorithm>

namespace steplap {

namespace {

constexpr std::size_t k_first_size = 4096;

TapeWriter& writer() {
  static thread_local TapeWriter own;
  return own;
}

} // namespace

void TapeWriter::grow() {
  const auto written = step - first_step, known = constant - first_constant;
  const std::size_t size = std::max(k_first_size, 2 * steps.size());
  steps.resize(size);
  constants.resize(size);
  first_step = steps.data();
  step = first_step + written;
  last_step = first_step + size;
  first_constant = constants.data();
  constant = first_constant + known;
  last_constant = first_constant + size;
}

void Traced::start() {
  TapeWriter& to = writer();
  if (to.steps.empty()) to.grow();
  to.step = to.first_step;
  to.constant = to.first_constant;
  to.outputs.clear();
  to.input_count = 0;
  TapeWriter::now = &to;
}

void Traced::finish(Tape* tape) {
  const TapeWriter& from = writer();
  TapeWriter::now = nullptr;
  if (!tape) return;
  tape->steps.assign(from.first_step, from.step);
  tape->constants.assign(from.first_constant, from.constant);
  tape->outputs = from.outputs;
  tape->input_count = from.input_count;
}

Traced Traced::input(double value) {
  Traced x(value);
  x.step_ = TapeWriter::now->put(TapeOperation::input, TapeWriter::now->input_count++, 0);
  return x;
}

void Traced::output(const Traced& x) { TapeWriter::now->outputs.push_back(x.step()); }

bool Traced::decided(const Traced& a, const Traced& b) {
  const bool is_less = a.value_ < b.value_;
  if (a.is_constant() && b.is_constant()) return is_less;
  const std::int32_t first = a.step();
  TapeWriter::now->put(is_less ? TapeOperation::if_less : TapeOperation::if_not_less, first, b.step());
  return is_less;
}

} // namespace steplap
