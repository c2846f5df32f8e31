#pragma once

#include "trees/queries/rays.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace boxwood {

/// All hits of all rays, in the order of the chunks.
class AppendHits final : public HitSink {
  public:
    void begin(std::size_t chunks, bool) override { parts_.assign(chunks, {}); }
    bool take(std::size_t chunk, std::uint32_t ray, std::span<const RayHit> hits) override {
        for (const RayHit& hit : hits)
            parts_[chunk].emplace_back(ray, hit);
        return true;
    }
    void end() override {
        for (const auto& part : parts_)
            all.insert(all.end(), part.begin(), part.end());
    }
    std::vector<std::pair<std::uint32_t, RayHit>> all;

  private:
    std::vector<std::vector<std::pair<std::uint32_t, RayHit>>> parts_;
};

} // namespace boxwood
