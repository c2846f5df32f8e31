/// `boxwood query collide | distance | tolerance | contacts`: one mesh or primitive against
/// another.

#include "bench/commands/command.h"
#include "bench/commands/queries/bodies.h"
#include "bench/commands/queries/body_pair.h"
#include "bench/commands/queries/query.h"
#include "bench/io/json.h"
#include "kernels/convex/signed_distance.h"
#include "kernels/suggest.h"
#include "kernels/triangle_distance/certified.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <iostream>
#include <vector>

namespace boxwood::bench {
namespace {

using Question = MeshesQuery::Question;

/// The two bodies, B seen from A.
class Bodies {
  public:
    Bodies(const MeshesQuery& query, QueryTimes& times)
        : pose_a_(read_pose(query.pose_a, "--pose-a")),
          b_in_a_(relative_pose(pose_a_, read_pose(query.pose_b, "--pose-b"))),
          pair_(query.a, query.b, {query.solid, query.bad_triangles, query.volume, &times}),
          times_(times) {}
    const BodyPair& pair() const { return pair_; }
    const Pose& b_in_a() const { return b_in_a_; }
    QueryTimes& times() const { return times_; }
    /// In world coordinates.
    Vec3<double> point(const Vec3<double>& in_a) const { return pose_a_(in_a); }
    Vec3<double> direction(const Vec3<double>& in_a) const { return pose_a_.rotated(in_a); }

  private:
    Pose pose_a_, b_in_a_;
    BodyPair pair_;
    QueryTimes& times_;
};

std::string json_triangle(std::uint32_t i) {
    return i == BodyPair::no_part ? "null" : fmt::format("{}", i);
}
std::string json_point(const Vec3<double>& p) {
    return fmt::format("[{},{},{}]", json_number(p.x), json_number(p.y), json_number(p.z));
}
std::string plain(const Vec3<double>& p) { return fmt::format("{},{},{}", p.x, p.y, p.z); }

void require_kernel(const std::string& asked, std::string_view known) {
    if (!asked.empty() && asked != known)
        throw BadInput(unknown_name("kernel of this query", asked, std::array{known}));
}

void answer_collide(const Bodies& bodies, const MeshesQuery& query, std::ostream& out) {
    const std::string_view kernel = bodies.pair().touch_kernel();
    require_kernel(query.kernel, kernel);
    const auto touch = [&] { return bodies.pair().touch(bodies.b_in_a()); };
    if (!query.format.json) {
        out << (query.format.header ? "collide\n" : "")
            << (bodies.times().answering(touch) ? "1\n" : "0\n");
        return;
    }
    struct Found {
        std::vector<Pair> pairs;
        bool touch;
    };
    const Found found = bodies.times().answering([&] {
        std::vector<Pair> pairs = bodies.pair().touching_parts(bodies.b_in_a(), query.limit);
        const bool has_pairs = !pairs.empty();
        return Found{std::move(pairs), has_pairs || touch()};
    });
    BlockWriter text(out);
    text << fmt::format("{{\"collide\":{},\"triangle_pairs\":[", found.touch ? "true" : "false");
    for (std::size_t i = 0; i < found.pairs.size(); ++i)
        text << fmt::format("{}[{},{}]", i ? "," : "", json_triangle(found.pairs[i].a),
                            json_triangle(found.pairs[i].b));
    text << fmt::format("],\"kernel\":{}{}}}\n", json_string(kernel), bodies.times().json());
}

void print_distance(const BodyDistance& d, const Vec3<double>& a, const Vec3<double>& b,
                    std::string_view kernel, const QueryTimes& times, const Format& format,
                    std::ostream& out) {
    if (format.json)
        out << fmt::format("{{\"distance\":{},\"lo\":{},\"hi\":{},\"point_a\":{},\"point_b\":{},"
                           "\"triangle_a\":{},\"triangle_b\":{},\"kernel\":{}{}}}\n",
                           json_number(d.distance), json_number(d.lo), json_number(d.hi),
                           json_point(a), json_point(b), json_triangle(d.parts.a),
                           json_triangle(d.parts.b), json_string(kernel), times.json());
    else
        out << (format.header ? "distance,lo,hi\n" : "")
            << fmt::format("{},{},{}\n", d.distance, d.lo, d.hi);
}

void answer_distance(const Bodies& bodies, const MeshesQuery& query, std::ostream& out) {
    const std::string_view kernel = bodies.pair().distance_kernel();
    require_kernel(query.kernel, kernel);
    DistanceOptions options;
    options.relative = query.relative;
    options.absolute = query.absolute;
    const BodyDistance d =
        bodies.times().answering([&] { return bodies.pair().distance(bodies.b_in_a(), options); });
    print_distance(d, bodies.point(d.point_a), bodies.point(d.point_b), kernel, bodies.times(),
                   query.format, out);
}

void answer_signed_distance(const MeshesQuery& query, QueryTimes& times, std::ostream& out) {
    const BodyReading how{true, query.bad_triangles, query.volume, &times};
    const NamedBody a = read_body(query.a, false, how), b = read_body(query.b, false, how);
    const bool has_mesh = a.has_triangles() || b.has_triangles();
    const std::string_view kernel = has_mesh ? CertifiedDistance::name : convex::gjk_epa_info.name;
    require_kernel(query.kernel, kernel);
    const PosedShape posed_a{a.shape, read_pose(query.pose_a, "--pose-a")},
        posed_b{b.shape, read_pose(query.pose_b, "--pose-b")};
    BodyDistance d;
    try {
        d = times.answering([&] { return signed_distance(posed_a, posed_b); });
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("--signed: {}", error.what()));
    }
    print_distance(d, d.point_a, d.point_b, kernel, times, query.format, out);
}

void answer_tolerance(const Bodies& bodies, const MeshesQuery& query, std::ostream& out) {
    require_kernel(query.kernel, bodies.pair().distance_kernel());
    const MeshWithin near = bodies.times().answering(
        [&] { return bodies.pair().within(bodies.b_in_a(), *query.tolerance); });
    if (query.format.json)
        out << fmt::format("{{\"within\":{},\"lo\":{},\"hi\":{}{}}}\n",
                           near.within ? "true" : "false", json_number(near.lo),
                           json_number(near.hi), bodies.times().json());
    else
        out << (query.format.header ? "within\n" : "") << (near.within ? "1\n" : "0\n");
}

void answer_contacts(const Bodies& bodies, const MeshesQuery& query, std::ostream& out) {
    require_kernel(query.kernel, bodies.pair().touch_kernel());
    ContactOptions options;
    options.max_pairs = query.limit;
    if (query.reduce)
        options.max_contacts = 4;
    const std::vector<BodyContact> found =
        bodies.times().answering([&] { return bodies.pair().contacts(bodies.b_in_a(), options); });
    BlockWriter text(out);
    if (query.format.json)
        text << "{\"contacts\":[";
    else if (query.format.header)
        text << "x,y,z,normal_x,normal_y,normal_z,depth\n";
    bool is_first = true;
    for (const BodyContact& c : found) {
        const Vec3<double> point = bodies.point(c.point), normal = bodies.direction(c.normal);
        if (query.format.json)
            text << fmt::format("{}{{\"point\":{},\"normal\":{},\"depth\":{}}}",
                                is_first ? "" : ",", json_point(point), json_point(normal),
                                json_number(c.depth));
        else
            text << fmt::format("{},{},{}\n", plain(point), plain(normal), c.depth);
        is_first = false;
    }
    if (query.format.json)
        text << fmt::format("]{}}}\n", bodies.times().json());
}

void require_numbers(const MeshesQuery& query) {
    const auto require = [](const char* option, double x) {
        if (!(x >= 0) || !std::isfinite(x))
            throw BadInput(
                fmt::format("{} is {}; it must be a finite number, at least 0", option, x));
    };
    if (query.question == Question::tolerance) {
        if (!query.tolerance)
            throw BadInput("query tolerance needs --tolerance T: are the two at most T apart?");
        require("--tolerance", *query.tolerance);
    }
    require("--absolute", query.absolute);
    require("--relative", query.relative);
    if (!(query.relative < 1))
        throw BadInput(fmt::format("--relative is {}; it is the share of the answer that it may be "
                                   "too far, below 1",
                                   query.relative));
    if (query.is_signed && (query.relative > 0 || query.absolute > 0))
        throw BadInput("--relative and --absolute are of distances without --signed");
}

} // namespace

void run(const MeshesQuery& query, std::ostream& out) {
    require_numbers(query);
    QueryTimes times(query.times);
    if (query.is_signed) {
        answer_signed_distance(query, times, out);
    } else {
        const Bodies bodies(query, times);
        switch (query.question) {
        case Question::collide:
            answer_collide(bodies, query, out);
            break;
        case Question::distance:
            answer_distance(bodies, query, out);
            break;
        case Question::tolerance:
            answer_tolerance(bodies, query, out);
            break;
        case Question::contacts:
            answer_contacts(bodies, query, out);
            break;
        }
    }
    if (!query.format.json)
        times.report();
}

void add_query_meshes(CLI::App& query) {
    struct Row {
        Question question;
        const char *name, *summary, *footer;
    };
    static constexpr Row rows[] = {
        {Question::collide, "collide", "whether two meshes or primitives touch",
         "Prints 1 or 0: of two meshes exactly for the corners as the poses put them (doubles), of "
         "others 1 where\nrounding leaves it open. With --json the pairs of triangles, too.\n\n"
         "Example:\n  boxwood query collide gripper.stl sphere:.05 "
         "--pose-b \"1 0 0 .1 0 1 0 0 0 0 1 0 0 0 0 1\""},
        {Question::distance, "distance", "how far two meshes or primitives are apart",
         "Prints distance,lo,hi: the true distance lies between lo and hi, of meshes 2^-32 of it "
         "apart; all are 0 where the two\ncertainly touch. With --signed minus the depth there: of "
         "primitives the least way that parts them; where one is a\nclosed mesh the farthest that "
         "a "
         "point of one's surface inside the other is from the other's, within a hundredth\nof the "
         "smaller one.\n\nExample:\n  boxwood query distance gripper.stl cup.obj --json\n"
         "  boxwood query distance gripper.stl half_space:0,0,1,-.5 --relative .01 --times"},
        {Question::tolerance, "tolerance",
         "whether two meshes or primitives are at most so far apart",
         "Prints 1 or 0.\n\nExample:\n  boxwood query tolerance gripper.stl cup.obj --tolerance "
         "0.02"},
        {Question::contacts, "contacts", "where two meshes or primitives touch, and how deep",
         "Prints x,y,z,normal_x,normal_y,normal_z,depth of each pair of triangles that touch, of "
         "each triangle that\ntouches a primitive, or of two primitives, the deepest first: B has "
         "to move by depth along the normal for\nthe two to touch at "
         "most.\n\nExample:\n  boxwood query contacts gripper.stl cup.obj --reduce"},
    };
    for (const Row& row : rows) {
        auto options = std::make_shared<MeshesQuery>();
        options->question = row.question;
        CLI::App* command = query.add_subcommand(row.name, row.summary);
        command->add_option("A", options->a, body_form)->required();
        command->add_option("B", options->b, "another, or the same")->required();
        command->add_option("--pose-a", options->pose_a,
                            "where A is: 16 numbers, a 4 x 4 matrix row by row");
        command->add_option("--pose-b", options->pose_b, "where B is");
        command->add_option("--kernel", options->kernel,
                            "the kernel that decides; there is one so far, which is the default");
        command->add_flag("--solid", options->solid,
                          "closed meshes are solids: what lies inside one touches it");
        if (row.question == Question::distance) {
            command->add_flag("--signed", options->is_signed,
                              "of closed meshes and what is solid: below 0 they overlap");
            command->add_option("--relative", options->relative,
                                "the share of the answer that it may be farther than the least "
                                "distance: 0.1 for 10 %; lo and hi hold, and less is computed");
            command->add_option("--absolute", options->absolute,
                                "and so much more, scene units: hi <= (lo + absolute) / (1 - "
                                "relative)");
        }
        if (row.question == Question::tolerance)
            command->add_option("--tolerance", options->tolerance, "how far, scene units");
        if (row.question == Question::collide || row.question == Question::contacts)
            command
                ->add_option("--limit", options->limit,
                             "look at so many touching pairs of triangles at most")
                ->capture_default_str();
        if (row.question == Question::contacts)
            command->add_flag("--reduce", options->reduce,
                              "at most four: the deepest, and those that span the most");
        add_bad_triangles_option(*command, options->bad_triangles);
        add_volume_option(*command, options->volume);
        add_times_option(*command, options->times);
        add_format_options(*command, options->format);
        command->footer(body_forms() + row.footer);
        command->callback([options] { run(*options, std::cout); });
    }
}

} // namespace boxwood::bench
