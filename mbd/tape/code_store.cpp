#include "mbd/tape/code_store.h"

#include <unordered_map>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_most_tapes = 500, k_most_kinds = 4000;

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
  std::unordered_map<std::uint64_t, std::shared_ptr<KnownKind>> kinds;
};

Store all_code; // made before main(): threads use it

} // namespace

void StoredCode::note_use(long evaluations) {
  if (evaluations_.fetch_add(evaluations) + evaluations >= k_enough) make();
}

const MachineCode* StoredCode::code() const {
  const std::scoped_lock lock(mutex_);
  return made_ ? &made_ : nullptr;
}

void StoredCode::make() {
  const std::scoped_lock lock(mutex_);
  if (is_made_) return;
  is_made_ = true;
  made_ = MachineCode(simplified(tape_));
}

std::shared_ptr<StoredCode> KnownKind::coded() const {
  const std::scoped_lock lock(mutex_);
  return stored_ && stored_->code() ? stored_ : nullptr;
}

void KnownKind::keep(std::shared_ptr<StoredCode> stored) {
  const std::scoped_lock lock(mutex_);
  stored_ = std::move(stored);
}

std::shared_ptr<KnownKind> known_kind(std::uint64_t key) {
  Store& all = all_code;
  const std::scoped_lock lock(all.mutex);
  if (all.kinds.size() >= k_most_kinds && !all.kinds.contains(key)) all.kinds.clear();
  std::shared_ptr<KnownKind>& kind = all.kinds[key];
  if (!kind) kind = std::make_shared<KnownKind>();
  return kind;
}

std::shared_ptr<StoredCode> stored_code(const Tape& tape) {
  const std::uint64_t hash = hash_of(tape);
  Store& all = all_code;
  const std::scoped_lock lock(all.mutex);
  const auto [begin, end] = all.codes.equal_range(hash);
  for (auto at = begin; at != end; ++at)
    if (at->second->is_of(tape)) return at->second;
  if (all.codes.size() >= k_most_tapes) all.codes.clear();
  return all.codes.emplace(hash, std::make_shared<StoredCode>(tape))->second;
}

} // namespace steplap
