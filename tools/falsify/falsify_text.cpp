#include <algorithm>
#include <fmt/format.h>

#include "tools/falsify/falsify_result.hpp"

namespace tools {

std::vector<const FalsifySearch*> Worst(const FalsifyResult& result, std::size_t most) {
  std::vector<const FalsifySearch*> worst;
  for (const FalsifySearch& search : result.searches) {
    if (search.worst) worst.push_back(&search);
  }
  std::ranges::stable_sort(worst, {}, [](const FalsifySearch* search) { return search->worst->margin; });
  worst.resize(std::min(worst.size(), most));
  return worst;
}

std::string ToText(const FalsifyResult& result, std::size_t most) {
  int violated = 0, impossible = 0;
  for (const FalsifySearch& search : result.searches) {
    violated += search.violated;
    impossible += search.impossible;
  }
  std::string text = fmt::format(
      "{}\na contact by the vehicle's fault, or off the road: {} drives; {} more, in which there was no way, "
      "do not "
      "count\n\nThe worst of each search; margin: clearance or distance from the road's edge\n",
      result.setup.Describe(), violated, impossible);
  for (const FalsifySearch* search : Worst(result, most)) {
    const Finding& finding = *search->worst;
    text += fmt::format("\n  {:.3f} m, {}{}{}; possible: {}; search {}\n      {}\n      {}\n", finding.margin,
                        NameOf(finding.outcome), finding.why.empty() ? "" : ": ", finding.why,
                        NameOf(finding.way), search->index, finding.description,
                        result.setup.CommandToDriveAgain(finding.key));
  }
  return text;
}

}  // namespace tools
