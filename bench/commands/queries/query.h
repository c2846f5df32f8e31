#pragma once

#include "bench/commands/queries/robot_case.h"
#include "bench/commands/queries/user_mesh.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/world/mesh_tree.h"
#include "trees/world/robot_collision.h"

#include <memory>
#include <optional>
#include <ostream>
#include <string>

namespace CLI {
class App;
}

namespace boxwood::bench {

/// Which tree answers a query, on which threads.
struct TreeChoice {
    std::string builder = "binned_sah", layout = "wide8", executor = "tbb";
    std::optional<unsigned> threads; ///< all cores if not given (`serial`: one)
};

/// The options --builder, --layout, --executor and --threads, under a heading that says how they
/// change the answers.
void add_tree_options(CLI::App& app, TreeChoice& choice, const std::string& effect_on_answers);

/// What the names of a choice stand for. Throw BadInput, with a suggestion, for an unknown name.
BuildFunction chosen_builder(const TreeChoice& choice);
const LayoutEntry& chosen_layout(const TreeChoice& choice);
std::unique_ptr<Executor> chosen_executor(const TreeChoice& choice);

/// How answers are printed.
struct Format {
    bool header = false; ///< a line of column names first
    bool json = false;   ///< one object instead of lines
};
void add_format_options(CLI::App& app, Format& format);

/// Collects text and hands it on in large pieces.
class BlockWriter {
  public:
    explicit BlockWriter(std::ostream& out) : out_(out) {}
    ~BlockWriter() { flush(); }
    BlockWriter(const BlockWriter&) = delete;
    BlockWriter& operator=(const BlockWriter&) = delete;

    BlockWriter& operator<<(std::string_view text);
    BlockWriter& operator<<(std::uint32_t number);
    BlockWriter& operator<<(float number); ///< shortest form that reads back as the same float
    void flush();

  private:
    std::ostream& out_;
    std::string block_;
};

struct PairsQuery {
    std::string boxes; ///< a file of rows min_x,min_y,min_z,max_x,max_y,max_z; - for standard input
    TreeChoice tree;
    std::optional<std::string> device; ///< "cuda:0"; none: the tree answers
    Format format;
    bool count = false;                     ///< only how many
    std::optional<std::uint64_t> limit;     ///< at most so many pairs, not with `count`
    std::optional<std::uint64_t> max_bytes; ///< of the list; all that is available if not given
};
/// Prints every unordered pair of boxes that share a point, once, sorted. Exact in double. Throws
/// BadInput if the list does not fit in the memory that is available, and Interrupted.
void run(const PairsQuery& query, std::ostream& out);
/// Of a file of boxes, which are finite; - for standard input. Throws BadInput naming the line.
std::vector<Aabb<double>> read_boxes(const std::string& path);
/// Outward, so that boxes that share a point still do; those beyond the range of floats end there.
Box rounded_to_floats(const Aabb<double>& box);
void add_query_pairs(CLI::App& query);

struct RaysQuery {
    std::string mesh; ///< a mesh file
    std::string rays; ///< a file of rows ox,oy,oz,dx,dy,dz[,tmax]; - for standard input
    TreeChoice tree;
    Format format;
    std::string kernel = "watertight";
    bool any = false; ///< only whether a ray hits
};
/// Prints for each ray its nearest triangle, or whether there is one.
void run(const RaysQuery& query, std::ostream& out);
void add_query_rays(CLI::App& query);

struct TrianglesQuery {
    std::string pairs;     ///< a file of rows of 18 numbers; - for standard input
    std::string kernel;    ///< guigue_devillers_exact, or certified for distances, if empty
    bool distance = false; ///< distance,lo,hi instead of 0 or 1
    Format format;
};
/// Prints for each pair whether the triangles touch, or how far apart they are.
void run(const TrianglesQuery& query, std::ostream& out);
void add_query_triangles(CLI::App& query);

/// Of two bodies: each a mesh file or a primitive (bodies.h).
struct MeshesQuery {
    enum class Question : std::uint8_t { collide, distance, tolerance, contacts };
    Question question = Question::collide;
    std::string a, b;
    std::string pose_a, pose_b; ///< 16 numbers, row by row; the identity if empty
    std::string kernel;         ///< the one there is, if empty
    std::optional<double> tolerance;
    bool solid = false; ///< closed meshes, and what lies inside touches
    BadTriangles bad_triangles = BadTriangles::keep;
    MeshVolume volume = MeshVolume::obb;
    bool is_signed = false;            ///< distance: below 0 where they overlap
    double relative = 0, absolute = 0; ///< distance: how much too far it may be
    bool reduce = false;               ///< contacts: at most four
    std::size_t limit = 1'000'000;     ///< touching pairs of triangles that are looked at
    bool times = false;                ///< QueryTimes, too
    Format format;
};
/// Prints whether they touch, how far apart they are, whether they are near, or where they touch.
/// Throws BadInput.
void run(const MeshesQuery& query, std::ostream& out);
void add_query_meshes(CLI::App& query);

/// Of two bodies that move.
struct ContinuousQuery {
    std::string a, b;
    std::string from_a, to_a, from_b, to_b; ///< 16 numbers each, row by row
    std::string motion = "linear";          ///< or screw
    bool solid = false;                     ///< closed meshes: what begins inside touches at 0
    BadTriangles bad_triangles = BadTriangles::keep;
    MeshVolume volume = MeshVolume::obb;
    bool times = false;
    Format format;
};
/// Prints whether and when they first touch. Throws BadInput.
void run(const ContinuousQuery& query, std::ostream& out);
void add_query_continuous(CLI::App& query);

struct CcdQuery {
    std::string queries; ///< a file of rational queries (ccd_file.h); - for standard input
    std::string kind;    ///< vertex-face | edge-edge
    std::string kernel = "exact";
    std::optional<double> tolerance;       ///< of tight_inclusion
    std::optional<std::size_t> max_checks; ///< of tight_inclusion
    Format format;
};
/// Prints for each query 1 if the features touch, or if the kernel cannot tell, else 0.
void run(const CcdQuery& query, std::ostream& out);
void add_query_ccd(CLI::App& query);

struct RobotQuery {
    RobotFiles files;
    std::optional<std::string> joints;   ///< "name=value,..."; the others at rest
    std::optional<std::string> state;    ///< a name of the SRDF file
    std::optional<std::uint64_t> random; ///< so many states at random
    std::optional<std::uint64_t> steps;  ///< from each of them to the next, in so many
    std::optional<std::string> svg;      ///< the least distance over time, drawn
    std::uint64_t seed = 1;
    std::optional<std::uint64_t> samples; ///< propose pairs by so many
    std::optional<std::string> write_srdf;
    std::vector<std::string> obstacles; ///< bodies that stand around it (surroundings.h)
    std::vector<std::string> allow;     ///< "LINK,LINK" or "LINK,OBSTACLE"
    bool times = false;
    Format format;
};
/// Prints links, joints and allowed pairs of a robot; and for each state the pairs of links whose
/// boxes overlap, those of them that are tested and that collide, and the least distance; and the
/// same of links and obstacles, if there are any.
void run(const RobotQuery& query, const MakeLinkNarrowPhase& narrow_phase, std::ostream& out);
void add_query_robot(CLI::App& query, MakeLinkNarrowPhase narrow_phase);

} // namespace boxwood::bench
