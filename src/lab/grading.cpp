#include "lab/grading.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace trackbed {
std::vector<double> draw_sizes(const GradingInput& grading, const Space& space, double solid_volume,
                               Rng& rng) {
  std::vector<double> sizes;
  for (std::size_t band = 1; band < grading.sieves.size(); ++band) {
    const double share = (grading.passing[band] - grading.passing[band - 1]) * solid_volume;
    double volume = 0;
    while (volume < share) {
      const double size = rng.uniform(grading.sieve(band - 1), grading.sieve(band));
      const double more = space.volume_of_size(size);
      if (volume + more - share > share - volume) break;
      volume += more;
      sizes.push_back(size);
    }
  }
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return sizes;
}

double smallest_size(const GradingInput& grading) {
  const auto band = std::ranges::adjacent_find(grading.passing, std::less<>());
  return grading.sieve(static_cast<std::size_t>(band - grading.passing.begin()));
}

double scale_to_size(const GradingInput& grading, const Space& space, const ClumpTemplate& stone,
                     double size) {
  if (grading.size == "sieve") return size / stone.sieve_size;
  return size / space.size_of_volume(stone.volume);
}

std::vector<double> passing(const GradingInput& grading, const Space& space,
                            const std::vector<double>& sizes) {
  std::vector<double> shares;
  double all = 0;
  for (double size : sizes) all += space.volume_of_size(size);
  for (std::size_t k = 0; k < grading.sieves.size(); ++k) {
    double below = 0;
    for (double size : sizes)
      if (size < grading.sieve(k)) below += space.volume_of_size(size);
    shares.push_back(all > 0 ? below / all : 0);
  }
  return shares;
}

std::vector<Result> passing_results(const GradingInput& grading, const Space& space,
                                    const std::vector<double>& sizes) {
  const std::vector<double> shares = passing(grading, space, sizes);
  std::vector<Result> results;
  for (std::size_t k = 0; k < shares.size(); ++k)
    results.push_back({fmt::format("passing_{:g}_mm", 1e3 * grading.sieves[k]), shares[k], Dimension::none});
  return results;
}

void declare_passing(Fields& f) {
  f.gives("passing_NUMBER_mm", Dimension::none, "share by volume that passes each sieve of the grading");
}

}  // namespace trackbed
