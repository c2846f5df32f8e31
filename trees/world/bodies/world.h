#pragma once

#include "trees/executor.h"
#include "trees/inspect/work.h"
#include "trees/queries/sinks.h"
#include "trees/world/allowed_pairs.h"
#include "trees/world/bodies/body_shape.h"
#include "trees/world/bodies/ledger.h"
#include "trees/world/bodies/shape_pairs.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace boxwood {

struct WorldOptions {
    unsigned threads = 1;                               ///< of questions about many pairs
    std::shared_ptr<const Executor> executor = nullptr; ///< one of your own, instead of threads
    bool is_timed = false;                              ///< whether the ledger has times
};

struct BodyOptions {
    std::string name{}; ///< to find it by; no two bodies have one
    /// Bits. Two bodies may meet if each is in a group that the other's mask has.
    std::uint32_t group = 1, mask = ~std::uint32_t{0};
    /// Scene units: the body is all that is at most so far from its shape, at every stage and for
    /// every class of shapes. At least 0.
    double margin = 0;
};

/// Where a body goes from its pose while t goes from 0 to 1.
struct BodyMotion {
    std::uint32_t body = 0;
    Pose to{};
    MotionPath path = MotionPath::linear;
};

struct BodyFirstContact {
    Pair bodies{};
    FirstContact contact{}; ///< its triangles are parts
};

/// What may be asked of a World, for its plan.
enum class WorldQuery : std::uint8_t {
    candidates,
    collide,
    distance,
    within,
    contacts,
    first_contact
};

/// Bodies that come, go and move, and questions about those of them that may meet: by their groups
/// and masks, and unless their collision is allowed. Boxes of bodies are searched by a tree that
/// follows them, then shapes decide (shape_pairs.h). The tree of a mesh is built when two boxes
/// first bring it up, once for all bodies that share it; planes and half-spaces are in no tree.
///
/// Bodies have numbers; that of one that was removed may be given to a later one. A number of none
/// throws std::invalid_argument. What throws changes nothing. Answers come in order of their bodies
/// unless said otherwise, the lower body first, and are the same for any number of threads; where
/// it is within rounding whether two touch, they do.
/// Threads: any number of them may call const members at the same time; who changes the world is
/// alone with it meanwhile.
class World {
  public:
    explicit World(const WorldOptions& options = {});
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    ~World();

    // Bodies: each of these takes as long for a mesh of a million triangles as for one.

    /// Throws as checked_pose, and std::invalid_argument for a margin below 0, NaN or beyond 2^60
    /// and for a name that another body has.
    std::uint32_t insert(BodyShape shape, const Pose& pose = {}, const BodyOptions& options = {});
    void remove(std::uint32_t body);
    void clear();
    /// Where it is now; throws as checked_pose. Of many at once: as many poses as bodies, else
    /// std::invalid_argument.
    void set_pose(std::uint32_t body, const Pose& pose);
    void set_poses(std::span<const std::uint32_t> bodies, std::span<const Pose> poses);
    void set_margin(std::uint32_t body, double margin);
    void set_groups(std::uint32_t body, std::uint32_t group, std::uint32_t mask);

    std::size_t size() const { return count_; }
    bool empty() const { return count_ == 0; }
    bool contains(std::uint32_t body) const {
        return body < bodies_.size() && bodies_[body].shape.has_value();
    }
    bool contains(std::string_view name) const { return names_.find(name) != names_.end(); }
    std::vector<std::uint32_t> bodies() const; ///< ascending
    /// The body of that name; throws std::invalid_argument, with a suggestion, if there is none.
    std::uint32_t find(std::string_view name) const;
    const std::string& name(std::uint32_t body) const { return at(body).name; }
    const BodyShape& shape(std::uint32_t body) const { return *at(body).shape; }
    const Pose& pose(std::uint32_t body) const { return at(body).pose; }
    double margin(std::uint32_t body) const { return at(body).margin; }
    /// A box around the body and its margin; of an empty mesh the empty one.
    const Box& box(std::uint32_t body) const { return at(body).box; }

    // Which may meet: symmetric. Of a body that is removed all is forgotten.

    /// Again for a pair: reason and note are replaced. Throw as AllowedPairs.
    void allow(std::uint32_t a, std::uint32_t b, AllowedReason reason = AllowedReason::user,
               std::string note = {});
    void disallow(std::uint32_t a, std::uint32_t b);
    /// All of them, by the names of their items; throws for one that no body has.
    void allow(const AllowedPairs& pairs);
    std::optional<AllowedReason> allowed(std::uint32_t a, std::uint32_t b) const;
    std::vector<AllowedPair> allowed_pairs() const; ///< of bodies, in their order
    bool may_meet(std::uint32_t a, std::uint32_t b) const;

    /// The tree takes in what changed; else the next query has it do so.
    void update();

    // Candidates: those that may meet whose boxes are at most `tolerance` apart. A tolerance is at
    // least 0 and below 2^60, here and below, else std::invalid_argument.

    std::vector<Pair> candidates(double tolerance = 0) const;
    std::vector<std::uint32_t> candidates_of(std::uint32_t body, double tolerance = 0) const;
    /// Into a sink, in no order, as one chunk. What is allowed is left out where leaves meet; masks
    /// are tested with the boxes on the way down the tree where they keep most pairs apart.
    /// `work`, if given, is added to.
    void candidates(PairSink& sink, double tolerance = 0, Work* work = nullptr) const;

    // Two bodies, whether or not they may meet. Of b and a the answer is that of a and b.

    Answer collide(std::uint32_t a, std::uint32_t b) const;
    Answer within(std::uint32_t a, std::uint32_t b, double tolerance) const;
    BodyDistance distance(std::uint32_t a, std::uint32_t b,
                          const DistanceOptions& options = {}) const;
    /// As shape_pairs.h says, and throws.
    BodyDistance signed_distance(std::uint32_t a, std::uint32_t b, double tolerance = 0) const;
    std::vector<BodyContact> contacts(std::uint32_t a, std::uint32_t b,
                                      const ContactOptions& options = {}) const;

    // All that may meet.

    std::vector<Pair> collisions() const;
    std::vector<std::uint32_t> collisions_of(std::uint32_t body) const;
    /// One of them, if there is any; which one depends on the history.
    std::optional<Pair> any_collision() const;

    /// The nearest pair, if one is nearer than `limit`; of pairs as near one of them. lo is at most
    /// the least distance of all. Boxes that are nearer are looked at first, and what cannot be
    /// nearer than the best so far is skipped. With options the nearest may be farther, as they
    /// say of a pair, and less is looked at; options.start has no effect. `work`, if given, is
    /// added to.
    std::optional<BodyDistance>
    least_distance(double limit = std::numeric_limits<double>::infinity()) const;
    std::optional<BodyDistance> least_distance(const DistanceOptions& options,
                                               Work* work = nullptr) const;
    std::optional<BodyDistance>
    least_distance_of(std::uint32_t body,
                      double limit = std::numeric_limits<double>::infinity()) const;
    std::optional<BodyDistance> least_distance_of(std::uint32_t body,
                                                  const DistanceOptions& options,
                                                  Work* work = nullptr) const;
    /// Those at most `tolerance` apart; how far they are.
    std::vector<Pair> within(double tolerance) const;
    std::vector<BodyDistance> distances(double tolerance) const;

    /// By pairs, in each the deepest first; options are for a pair.
    std::vector<BodyContact> contacts(const ContactOptions& options = {}) const;

    /// First contacts of bodies of which one moves at least, the earliest first; others stay where
    /// they are. One motion to a body, else std::invalid_argument; throws as checked_pose.
    std::vector<BodyFirstContact> first_contacts(std::span<const BodyMotion> motions,
                                                 const ContinuousOptions& options = {}) const;

    // What is done for an answer.

    /// Every stage there is, and whether these queries of this world require it.
    std::vector<PlannedStage> plan(std::span<const WorldQuery> queries) const;
    /// The same stages, and what they did since the start or clear_ledger.
    Ledger ledger(std::span<const WorldQuery> queries = {}) const;
    void clear_ledger();

  private:
    struct Body {
        std::optional<BodyShape> shape; ///< nothing of a number that is free
        Pose pose;
        double margin = 0;
        Box box{};
        std::string name;
    };
    struct State;
    struct Search;
    struct Nearest;
    struct NameHash {
        using is_transparent = void;
        std::size_t operator()(std::string_view name) const {
            return std::hash<std::string_view>()(name);
        }
    };

    const Body& at(std::uint32_t body) const;
    Body& at(std::uint32_t body) { return const_cast<Body&>(std::as_const(*this).at(body)); }
    PosedShape posed(std::uint32_t body) const;
    void place(std::uint32_t body);
    static void require_tolerance(double tolerance);
    Search search() const;
    bool boxes_are_near(const Search& where, Pair pair, double tolerance) const;
    bool are_near(const Search& where, Pair pair, double tolerance) const;
    template <class Visit>
    void each_pair(const Search& where, double tolerance, Work* work, const Visit& visit) const;
    const PackedLayout& layout_for_one() const;
    std::vector<Pair> pairs_of_few(std::span<const Box> swept, std::span<const std::uint8_t> moving,
                                   std::span<const std::uint32_t> wide, double tolerance) const;
    std::vector<std::uint32_t> near_to(std::uint32_t body, double tolerance) const;
    void build_trees(std::span<const Pair> pairs) const;
    std::vector<Pair> ready_pairs(double tolerance = 0) const;
    template <class Found, class Decide>
    std::vector<Found> decided(std::span<const Pair> pairs, const Decide& decide) const;

    std::vector<Body> bodies_;
    std::vector<std::uint32_t> free_;
    std::size_t count_ = 0;
    std::unordered_map<std::string, std::uint32_t, NameHash, std::equal_to<>> names_;
    std::shared_ptr<const Executor> executor_;
    std::unique_ptr<State> state_; ///< at one place, as threads share it
};

} // namespace boxwood
