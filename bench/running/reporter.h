#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// Receives google-benchmark's numbers, one run at a time, and hands them on.
class Reporter final : public benchmark::BenchmarkReporter {
  public:
    explicit Reporter(std::function<void(const Run&)> take) : take_(std::move(take)) {}

    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        if (runs.size() != 1 || runs.front().error_occurred)
            throw std::runtime_error("google-benchmark did not report one run per sample");
        take_(runs.front());
    }

  private:
    std::function<void(const Run&)> take_;
};

} // namespace boxwood::bench
