#include "mbd/tape/code_store.h"

#include <unordered_map>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_most_tapes = 500, k_most_families = 4000;

// FNV-1a hash, one step at a time.
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
  std::unordered_multimap<std::uint64_t, std::shared_ptr<TapeCode>> codes;
  std::unordered_map<std::uint64_t, std::shared_ptr<TapeFamily>> families;
};

Store all_code; // constructed before main(), as threads use it

} // namespace

void TapeCode::count_uses(long evaluations) {
  if (evaluations_.fetch_add(evaluations) + evaluations >= k_enough) make();
}

const MachineCode* TapeCode::code() const {
  const std::scoped_lock lock(mutex_);
  return made_ ? &made_ : nullptr;
}

void TapeCode::make() {
  const std::scoped_lock lock(mutex_);
  if (is_made_) return;
  is_made_ = true;
  made_ = MachineCode(simplified(tape_));
}

std::shared_ptr<TapeCode> TapeFamily::coded() const {
  const std::scoped_lock lock(mutex_);
  return code_ && code_->code() ? code_ : nullptr;
}

void TapeFamily::keep(std::shared_ptr<TapeCode> code) {
  const std::scoped_lock lock(mutex_);
  code_ = std::move(code);
}

std::shared_ptr<TapeFamily> tape_family(std::uint64_t key) {
  Store& all = all_code;
  const std::scoped_lock lock(all.mutex);
  if (all.families.size() >= k_most_families && !all.families.contains(key)) all.families.clear();
  std::shared_ptr<TapeFamily>& family = all.families[key];
  if (!family) family = std::make_shared<TapeFamily>();
  return family;
}

std::shared_ptr<TapeCode> shared_code(const Tape& tape) {
  const std::uint64_t hash = hash_of(tape);
  Store& all = all_code;
  const std::scoped_lock lock(all.mutex);
  const auto [begin, end] = all.codes.equal_range(hash);
  for (auto at = begin; at != end; ++at)
    if (at->second->is_of(tape)) return at->second;
  if (all.codes.size() >= k_most_tapes) all.codes.clear();
  return all.codes.emplace(hash, std::make_shared<TapeCode>(tape))->second;
}

} // namespace steplap
