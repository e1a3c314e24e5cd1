#include "mbd/tape/traced.h"

namespace steplap {

namespace {

thread_local Tape* writing = nullptr;

std::int32_t put(TapeOperation operation, std::int32_t a, std::int32_t b) {
  writing->steps.push_back({operation, a, b});
  return static_cast<std::int32_t>(writing->steps.size()) - 1;
}

} // namespace

void Traced::start(Tape& tape) {
  tape.steps.clear();
  tape.constants.clear();
  tape.outputs.clear();
  tape.input_count = 0;
  writing = &tape;
}

void Traced::finish() { writing = nullptr; }

Traced Traced::input(double value) {
  Traced x(value);
  x.step_ = put(TapeOperation::input, writing->input_count++, 0);
  return x;
}

void Traced::output(const Traced& x) { writing->outputs.push_back(x.step()); }

std::int32_t Traced::step() const {
  if (step_ >= 0) return step_;
  writing->constants.push_back(value_);
  return put(TapeOperation::constant, static_cast<std::int32_t>(writing->constants.size()) - 1, 0);
}

Traced Traced::made(TapeOperation operation, const Traced& a, const Traced& b, double value) {
  Traced x(value);
  if (a.is_constant() && b.is_constant()) return x;
  const std::int32_t first = a.step();
  x.step_ = put(operation, first, &a == &b ? first : b.step());
  return x;
}

bool Traced::decided(const Traced& a, const Traced& b) {
  const bool is_less = a.value_ < b.value_;
  if (a.is_constant() && b.is_constant()) return is_less;
  const std::int32_t first = a.step();
  put(is_less ? TapeOperation::if_less : TapeOperation::if_not_less, first, b.step());
  return is_less;
}

} // namespace steplap
