#include "bench/peers/answering.h"
#include "bench/peers/fcl/mesh_models.h"
#include "bench/peers/mesh_peers.h"
#include "bench/peers/mesh_queries.h"
#include "bench/tasks/detail/median_distance.h"

#include <limits>
#include <memory>

namespace boxwood::bench {
namespace {

template <class Volume>
ContenderEntry entry_of_meshes(const std::string& after, const std::string& how) {
    return entry_of_models<Volume>(after, how, how + ", pose after pose, at the same model");
}

template <class Volume> void append_touches(std::vector<ContenderEntry>& all) {
    using Models = MeshModels<Volume>;
    using Request = typename Models::CollisionRequest;
    constexpr std::size_t no_limit = std::numeric_limits<int>::max();
    for (const bool with_contact : {false, true}) {
        ContenderEntry& e = all.emplace_back(entry_of_meshes<Volume>(
            with_contact ? ".contact" : "",
            with_contact ? "collide for one contact, with its point and normal"
                         : "collide for one contact, without its point"));
        e.answers = {answering<FirstTouch<Models>>("collide", Request(1, with_contact))};
        if (with_contact)
            e.classes = {with_contact_class};
    }
    ContenderEntry& every = all.emplace_back(
        entry_of_meshes<Volume>(".all", "collide for all contacts, without their points"));
    every.answers = {answering<AllTouches<Models>>("collide_all", Request(no_limit, false))};
    ContenderEntry& deepest = all.emplace_back(entry_of_meshes<Volume>(
        ".contacts",
        "collide for all contacts, with points, normals and depths, and a sort by depth"));
    deepest.notes += "; up to two contacts of each pair of triangles";
    deepest.answers = {answering<AllContacts<Models>>("contacts", Request(no_limit, true))};
}

template <class Volume> void append_distances(std::vector<ContenderEntry>& all) {
    using Models = MeshModels<Volume>;
    using Request = typename Models::DistanceRequest;
    ContenderEntry& least =
        all.emplace_back(entry_of_meshes<Volume>(".distance", "distance with nearest points"));
    least.answers = {answering<LeastDistance<Models>>("distance", Request(true))};
    ContenderEntry& warm = all.emplace_back(entry_of_meshes<Volume>(
        ".distance.warm",
        "distance with nearest points, where the result starts at how far the triangles of the "
        "answer before are apart in the new pose"));
    warm.answers = {answering<WarmDistance<Models>>("distance", Request(true))};
    warm.classes = {warm_start_class};
    ContenderEntry& nearer = all.emplace_back(entry_of_meshes<Volume>(
        ".tolerance",
        "distance without nearest points, where the result starts at the tolerance, as MoveIt "
        "does: what is farther is left out, and a nearer pair does not end it"));
    nearer.answers = {{"tolerance", [](const Job& job) {
                           return std::make_unique<Nearer<Models>>(job, Request(false),
                                                                   median_distance(*job.scene));
                       }}};
}

template <class S> void append_all(std::vector<ContenderEntry>& all) {
    append_touches<fcl::OBBRSS<S>>(all);
    append_touches<fcl::OBB<S>>(all);
    append_distances<fcl::OBBRSS<S>>(all);
    append_distances<fcl::RSS<S>>(all);
}

} // namespace

std::vector<ContenderEntry> fcl_meshes() {
    std::vector<ContenderEntry> all;
    append_all<double>(all);
    append_touches<fcl::kIOS<double>>(all);
    append_distances<fcl::kIOS<double>>(all);
    append_all<float>(all);
    return all;
}

} // namespace boxwood::bench
