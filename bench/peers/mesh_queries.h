#pragma once

#include "bench/tasks/contender.h"
#include "bench/tasks/detail/mesh_pair_answers.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

/// The tasks of two meshes by the models of a library, M, written once for FCL and Coal. M is a
/// contender that builds one model, which stands for the mesh and for its copy, and has:
///     n_poses()
///     CollisionRequest; collide_at(pose, request) -> number of contacts
///     for_each_contact(visit): of the last collide_at; contacts with b1, b2, pos, normal
///     depth_of(contact): above 0 where the two overlap
///     S, its number
///     DistanceRequest; distance_at(pose, request, below) -> result with min_distance,
///         nearest_points, b1, b2, -1 where none is nearer than `below`, infinite if it is not
///         given
///     apart(triangles, pose): how far two triangles are
namespace boxwood::bench {

/// A library's vector, of floats or doubles.
template <class V> Vec3<double> as_doubles(const V& v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Of a result that names triangles.
template <class Result> PosedDistance::Points points_of(const Result& result) {
    return {as_doubles(result.nearest_points[0]), as_doubles(result.nearest_points[1])};
}

template <class Contact> PosedPair posed_pair(std::size_t pose, const Contact& contact) {
    return {static_cast<std::uint32_t>(pose), static_cast<std::uint32_t>(contact.b1),
            static_cast<std::uint32_t>(contact.b2)};
}

/// An M that gives its answers of each pose in turn, by one request.
template <class M, class Request, class Answer> class PosedQuery : public M {
  public:
    PosedQuery(const Job& job, Request request) : M(job), request_(std::move(request)) {}
    void query(Answers& answers) final {
        std::vector<Answer>& list = list_of<Answer>(answers);
        list.clear();
        for (std::size_t i = 0; i < this->n_poses(); ++i)
            append(i, list);
    }
    void query_part(Answers& answers, std::size_t part) final {
        append(part, list_of<Answer>(answers));
    }

  protected:
    virtual void append(std::size_t pose, std::vector<Answer>& list) = 0;

    Request request_;
};

/// Yes or no.
template <class M>
class FirstTouch final : public PosedQuery<M, typename M::CollisionRequest, std::uint8_t> {
    using PosedQuery<M, typename M::CollisionRequest, std::uint8_t>::PosedQuery;
    void append(std::size_t i, std::vector<std::uint8_t>& touches) override {
        touches.push_back(this->collide_at(i, this->request_) > 0);
    }
};

template <class M>
class AllTouches final : public PosedQuery<M, typename M::CollisionRequest, PosedPair> {
    using PosedQuery<M, typename M::CollisionRequest, PosedPair>::PosedQuery;
    void append(std::size_t i, std::vector<PosedPair>& touching) override {
        this->collide_at(i, this->request_);
        this->for_each_contact(
            [&](const auto& contact) { touching.push_back(posed_pair(i, contact)); });
    }
};

template <class M>
class AllContacts final : public PosedQuery<M, typename M::CollisionRequest, PosedContact> {
    using PosedQuery<M, typename M::CollisionRequest, PosedContact>::PosedQuery;
    void append(std::size_t i, std::vector<PosedContact>& found) override {
        this->collide_at(i, this->request_);
        const auto first = static_cast<std::ptrdiff_t>(found.size());
        this->for_each_contact([&](const auto& c) {
            found.push_back(
                {as_doubles(c.pos), as_doubles(c.normal), M::depth_of(c), posed_pair(i, c)});
        });
        std::sort(found.begin() + first, found.end(), is_before);
    }
};

template <class M>
class LeastDistance final : public PosedQuery<M, typename M::DistanceRequest, PosedDistance> {
    using PosedQuery<M, typename M::DistanceRequest, PosedDistance>::PosedQuery;
    void append(std::size_t i, std::vector<PosedDistance>& distances) override {
        const auto& result = this->distance_at(i, this->request_);
        const auto d = static_cast<double>(result.min_distance);
        const PosedPair pair = posed_pair(i, result);
        distances.push_back({d, d, d, {pair.a, pair.b}, points_of(result)});
    }
};

/// Each result starts at how far the nearest triangles of the pose before are apart in this one.
template <class M>
class WarmDistance final : public PosedQuery<M, typename M::DistanceRequest, PosedDistance> {
    using PosedQuery<M, typename M::DistanceRequest, PosedDistance>::PosedQuery;
    void append(std::size_t i, std::vector<PosedDistance>& distances) override {
        using Number = typename M::S;
        Pair triangles = distances.empty() ? Pair{} : distances.back().triangles;
        const Number start =
            distances.empty() ? std::numeric_limits<Number>::max() : this->apart(triangles, i);
        const auto& result = this->distance_at(i, this->request_, start);
        std::optional<PosedDistance::Points> points; // none where the start is the nearest
        if (result.b1 >= 0) {
            triangles = {static_cast<std::uint32_t>(result.b1),
                         static_cast<std::uint32_t>(result.b2)};
            points = points_of(result);
        }
        const auto d = static_cast<double>(result.min_distance);
        distances.push_back({d, d, d, triangles, points});
    }
};

/// Whether the two are nearer than the tolerance, where each result starts.
template <class M>
class Nearer final : public PosedQuery<M, typename M::DistanceRequest, std::uint8_t> {
    using Query = PosedQuery<M, typename M::DistanceRequest, std::uint8_t>;

  public:
    Nearer(const Job& job, typename M::DistanceRequest request, double tolerance)
        : Query(job, std::move(request)), tolerance_(static_cast<typename M::S>(tolerance)) {}

  private:
    void append(std::size_t i, std::vector<std::uint8_t>& nearer) override {
        nearer.push_back(this->distance_at(i, this->request_, tolerance_).b1 >= 0);
    }
    typename M::S tolerance_;
};

} // namespace boxwood::bench
