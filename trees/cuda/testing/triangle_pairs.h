#pragma once

#include "kernels/testing/triangle_pairs.h"
#include "trees/cuda/triangles/triangles.cuh"

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace boxwood::cuda {

/// Pairs of triangles as a device has them: i of one side with i of the other, the candidates in an
/// order of their own.
struct PairsOnDevice {
    std::vector<Vec3<float>> vertices[2];
    std::vector<Pair> candidates;
    std::uint64_t n; ///< of candidates, as the device knows it
    std::vector<std::uint32_t> places;
    std::uint32_t n_uncertain = 0, n_wide = 0;

    template <class Of>
    explicit PairsOnDevice(const std::vector<Of>& of)
        : candidates(of.size()), n(of.size()), places(of.size()) {
        for (std::uint32_t i = 0; i < of.size(); ++i) {
            candidates[i] = {i, i};
            for (const int side : {0, 1}) {
                const auto t = testing::as<float>(side == 0 ? of[i].a : of[i].b);
                vertices[side].insert(vertices[side].end(), {t.a, t.b, t.c});
            }
        }
        std::ranges::shuffle(candidates, std::mt19937(7));
    }
    Triangle<float> triangle(std::size_t side, std::uint32_t i) const {
        const Vec3<float>* v = vertices[side].data() + std::size_t{3} * i;
        return {v[0], v[1], v[2]};
    }
    TrianglesView side(std::size_t k) const { return {vertices[k].data(), nullptr}; }
    Candidates view() const {
        return {candidates.data(), &n, static_cast<std::uint32_t>(candidates.size())};
    }
    Uncertain none_uncertain() {
        n_uncertain = n_wide = 0;
        return {places.data(), &n_uncertain};
    }
};

} // namespace boxwood::cuda
