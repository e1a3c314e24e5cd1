#include "tools/study/counter_random.h"

#include "tools/study/law.h"

namespace steplap::study {

double CounterRandom::normal(std::uint64_t sample, std::uint32_t index) const { return normal_quantile(uniform(sample, index)); }

} // namespace steplap::study
