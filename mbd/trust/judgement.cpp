#include "mbd/trust/judgement.h"

#include <algorithm>

namespace steplap {

const char* name_of(Verdict verdict) {
  switch (verdict) {
  case Verdict::hold: return "hold";
  case Verdict::open: return "open";
  case Verdict::inspect: return "inspect";
  case Verdict::reject: break;
  }
  return "reject";
}

void add_cap(Judgement& judgement, const std::string& why) {
  judgement.caps.push_back(why);
  judgement.verdict = std::max(judgement.verdict, Verdict::open);
}

void distrust(Judgement& judgement, const std::string& why) {
  if (why.empty()) return;
  judgement.distrust += (judgement.distrust.empty() ? "" : "; ") + why;
  judgement.verdict = Verdict::open;
}

} // namespace steplap
