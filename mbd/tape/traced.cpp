#include "mbd/tape/traced.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace steplap {

namespace {

constexpr std::size_t k_first_size = 4096;

TapeWriter& writer() {
  static thread_local TapeWriter own;
  return own;
}

} // namespace

void TapeWriter::grow() {
  const std::size_t written = steps.empty() ? 0 : static_cast<std::size_t>(step - steps.data());
  const std::size_t kept = constants.empty() ? 0 : static_cast<std::size_t>(constant - first_constant);
  const std::size_t size = std::max(k_first_size, 2 * steps.size());
  steps.resize(size);
  constants.resize(size);
  step = steps.data() + written;
  last_with_room = steps.data() + size - k_room;
  first_constant = constants.data();
  constant = first_constant + kept;
}

void TapeNumber::start(const Tape* known) {
  TapeWriter& to = writer();
  if (to.steps.empty()) to.grow();
  to.step = to.steps.data();
  to.constant = to.first_constant;
  to.known = known;
  to.outputs.clear();
  to.count = to.input_count = 0;
  to.usual_outputs = 0;
  TapeWriter::now = &to;
}

bool TapeNumber::finish(Tape* tape) {
  const TapeWriter& from = writer();
  TapeWriter::now = nullptr;
  if (!tape) return false;
  tape->constants.assign(from.first_constant, from.constant);
  tape->outputs = from.outputs;
  tape->usual_outputs = from.usual_outputs;
  tape->input_count = from.input_count;
  tape->steps.clear();
  const auto size = static_cast<std::size_t>(from.count);
  if (!from.known) {
    tape->steps.assign(from.steps.data(), from.steps.data() + size);
    return true;
  }
  static_assert(std::has_unique_object_representations_v<TapeStep>);
  const Tape& known = *from.known;
  return size == known.steps.size() && tape->input_count == known.input_count && tape->usual_outputs == known.usual_outputs &&
         tape->outputs == known.outputs && std::memcmp(from.steps.data(), known.steps.data(), size * sizeof(TapeStep)) == 0;
}

TapeNumber TapeNumber::made_after_growing(TapeOperation operation, const TapeNumber& a, const TapeNumber& b, double value) {
  TapeWriter::now->grow();
  return made(operation, a, b, value);
}

TapeNumber TapeNumber::input(double value) {
  TapeNumber x(value);
  TapeWriter::now->make_room();
  x.step_ = TapeWriter::now->put(TapeOperation::input, TapeWriter::now->input_count++, 0);
  return x;
}

void TapeNumber::output(const TapeNumber& x) {
  TapeWriter::now->make_room();
  TapeWriter::now->outputs.push_back(x.step());
}

void TapeNumber::call(TapeFunction function, std::span<const TapeNumber> arguments, std::span<TapeNumber> results) {
  static thread_local std::vector<double> given, found;
  const TapeNumber address(std::bit_cast<double>(function));
  given.assign(1, value_of(address));
  for (const TapeNumber& x : arguments) given.push_back(value_of(x));
  found.assign(results.size(), 0.0);
  function(given.data(), found.data());
  for (std::size_t i = 0; i < results.size(); ++i) results[i] = TapeNumber(found[i]);
  if (std::all_of(arguments.begin(), arguments.end(), [](const TapeNumber& x) { return x.is_constant(); })) return;
  const auto put_argument = [](const TapeNumber& x, std::int32_t before) {
    TapeWriter::now->make_room();
    const std::int32_t step = x.step();
    return TapeWriter::now->put(TapeOperation::argument, step, before);
  };
  std::int32_t last = put_argument(address, -1);
  for (const TapeNumber& x : arguments) last = put_argument(x, last);
  TapeWriter::now->make_room();
  const std::int32_t made = TapeWriter::now->put(TapeOperation::call, last, static_cast<std::int32_t>(results.size()));
  for (std::size_t i = 0; i < results.size(); ++i) {
    TapeWriter::now->make_room();
    results[i].step_ = TapeWriter::now->put(TapeOperation::result, made, static_cast<std::int32_t>(i));
  }
}

bool TapeNumber::decided(const TapeNumber& a, const TapeNumber& b) {
  const bool is_less = a.value_ < b.value_;
  if (a.is_constant() && b.is_constant()) return is_less;
  TapeWriter::now->make_room();
  const std::int32_t first = a.step();
  TapeWriter::now->put(is_less ? TapeOperation::if_less : TapeOperation::if_not_less, first, b.step());
  return is_less;
}

} // namespace steplap
