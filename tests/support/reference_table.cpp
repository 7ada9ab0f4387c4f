#include "tests/support/reference_table.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace brume {
namespace {

double deviation(const ReferenceOutcome& o) {
  double largest = 0;
  for (const CaseResult& r : o.last()) largest = std::max(largest, std::abs(r.z));
  return largest;
}

std::string verdict(const ReferenceOutcome& o) {
  if (!o.unsupported.empty()) return "unsupported";
  if (!o.expected_failure.empty()) return "expected failure";
  return o.passed() ? "ok" : "FAILED";
}

std::vector<std::string> in_order(const std::vector<ReferenceOutcome>& outcomes, std::string ReferenceOutcome::*what) {
  std::vector<std::string> list;
  std::set<std::string> seen;
  for (const ReferenceOutcome& o : outcomes)
    if (seen.insert(o.*what).second) list.push_back(o.*what);
  return list;
}

std::string number(const char* format, double v) {
  char text[64];
  std::snprintf(text, sizeof text, format, v);
  return text;
}

}  // namespace

std::string format_outcomes(const std::vector<ReferenceOutcome>& outcomes) {
  std::string text;
  for (const ReferenceOutcome& o : outcomes) {
    if (!o.unsupported.empty()) {
      text += "unsupported       " + o.id + ": " + o.unsupported + "\n";
      continue;
    }
    const std::string head = verdict(o);
    for (const CaseResult& r : o.first) {
      char padded[32];
      std::snprintf(padded, sizeof padded, "%-17s ", o.second.empty() ? head.c_str() : "repeated");
      text += padded + r.to_string() + "\n";
    }
    for (const CaseResult& r : o.second) {
      char padded[32];
      std::snprintf(padded, sizeof padded, "%-17s ", head.c_str());
      text += padded + r.to_string() + "\n";
    }
    if (!o.expected_failure.empty())
      text += "                  " + o.expected_failure + "; relative standard deviation of a sample at least " +
              number("%.3g", o.relative_deviation) + "\n";
  }
  return text;
}

std::string format_summary(const std::vector<ReferenceOutcome>& outcomes) {
  std::string text;
  for (const std::string& method : in_order(outcomes, &ReferenceOutcome::method)) {
    std::set<std::string> cases;
    int comparisons = 0, failed = 0, repeated = 0, expected = 0, unsupported = 0;
    double largest = 0, noise = 0;
    for (const ReferenceOutcome& o : outcomes) {
      if (o.method != method) continue;
      if (!o.unsupported.empty()) {
        ++unsupported;
        continue;
      }
      cases.insert(o.id);
      if (!o.expected_failure.empty()) {
        ++expected;
        continue;
      }
      comparisons += static_cast<int>(o.last().size());
      failed += !o.passed();
      repeated += !o.second.empty();
      largest = std::max(largest, deviation(o));
      noise = std::max(noise, o.noise);
    }
    char line[256];
    std::snprintf(line, sizeof line,
                  "%-24s %4zu cases %5d comparisons %3d failed %3d repeated %3d expected failures %3d unsupported  "
                  "largest deviation %.2f  largest noise %.2g\n",
                  method.c_str(), cases.size(), comparisons, failed, repeated, expected, unsupported, largest, noise);
    text += line;
  }
  return text;
}

std::string format_table(const std::vector<ReferenceOutcome>& outcomes) {
  const auto files = in_order(outcomes, &ReferenceOutcome::file);
  std::string text = "| integrator |", rule = "|---|";
  for (const std::string& f : files) text += " " + f + " |", rule += "---|";
  text += "\n" + rule + "\n";
  for (const std::string& method : in_order(outcomes, &ReferenceOutcome::method)) {
    text += "| " + method + " |";
    for (const std::string& f : files) {
      double largest = -1;
      for (const ReferenceOutcome& o : outcomes)
        if (o.method == method && o.file == f && o.expected_failure.empty() && o.unsupported.empty())
          largest = std::max(largest, deviation(o));
      text += largest < 0 ? " |" : " " + number("%.1f", largest) + " |";
    }
    text += "\n";
  }
  return text;
}

std::string format_json(const std::vector<ReferenceOutcome>& outcomes) {
  nlohmann::json list = nlohmann::json::array();
  for (const ReferenceOutcome& o : outcomes) {
    nlohmann::json j{{"file", o.file}, {"id", o.id}, {"method", o.method}, {"verdict", verdict(o)}};
    if (!o.unsupported.empty()) j["reason"] = o.unsupported;
    if (!o.expected_failure.empty()) j["reason"] = o.expected_failure, j["relative_deviation"] = o.relative_deviation;
    for (const auto* results : {&o.first, &o.second})
      for (const CaseResult& r : *results)
        j[results == &o.first ? "first" : "repeated"].push_back({{"quantity", r.quantity},
                                                                 {"channel", r.channel},
                                                                 {"expected", r.expected},
                                                                 {"mean", r.mean},
                                                                 {"standard_error", r.standard_error},
                                                                 {"deviation", r.z},
                                                                 {"allowed", r.tolerance.total()},
                                                                 {"samples", r.samples},
                                                                 {"non_finite", r.non_finite},
                                                                 {"passed", r.passed}});
    list.push_back(std::move(j));
  }
  return list.dump(1) + "\n";
}

}  // namespace brume
