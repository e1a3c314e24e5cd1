#include "mbd/tape/code_store.h"

#include <unordered_map>

namespace steplap {

namespace {

constexpr std::size_t k_most_tapes = 500;

// FNV-1a, a step at a time.
std::uint64_t hash_of(const Tape& tape) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const TapeStep& s : tape.steps) {
    const auto a = static_cast<std::uint64_t>(s.a), b = static_cast<std::uint64_t>(s.b);
    hash = (hash ^ (static_cast<std::uint64_t>(s.operation) | a << 8U | b << 36U)) * 1099511628211ULL;
  }
  return hash;
}

struct Store {
  std::mutex mutex;
  std::unordered_multimap<std::uint64_t, std::shared_ptr<StoredCode>> codes;
};

Store& store() {
  static Store all;
  return all;
}

} // namespace

void StoredCode::note_use(long evaluations) {
  if (evaluations_.fetch_add(evaluations) + evaluations >= k_enough) make();
}

Tape StoredCode::tape() const {
  Tape tape;
  tape.steps = steps_;
  tape.outputs = outputs_;
  tape.input_count = input_count_;
  return simplified(tape);
}

void StoredCode::make() {
  std::call_once(is_made_, [this] {
    made_ = MachineCode(tape());
    if (made_) code_.store(&made_, std::memory_order_release);
  });
}

const MachineCode* StoredCode::lane_code() { return evaluations_.load() >= k_enough ? make_lanes() : nullptr; }

const MachineCode* StoredCode::make_lanes() {
  std::call_once(are_lanes_made_, [this] { made_lanes_ = MachineCode(tape(), MachineCode::most_lanes()); });
  return made_lanes_ ? &made_lanes_ : nullptr;
}

std::shared_ptr<StoredCode> stored_code(const Tape& tape) {
  const std::uint64_t hash = hash_of(tape);
  Store& all = store();
  const std::scoped_lock lock(all.mutex);
  const auto [begin, end] = all.codes.equal_range(hash);
  for (auto at = begin; at != end; ++at)
    if (at->second->is_of(tape)) return at->second;
  if (all.codes.size() >= k_most_tapes) all.codes.clear();
  return all.codes.emplace(hash, std::make_shared<StoredCode>(tape))->second;
}

} // namespace steplap
