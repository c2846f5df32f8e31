#include "core.h"
#include "poses.h"
#include "shapes.h"

#include "trees/world/bodies/world.h"

#include <pybind11/stl.h>

#include <cstddef>
#include <limits>
#include <optional>

namespace boxwood::python {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

std::int64_t part_of(std::uint32_t part) { return part == ~0u ? -1 : std::int64_t{part}; }

py::object answer_of(const BodyDistance& d) {
    return named_tuple("BodyDistance")(d.bodies.a, d.bodies.b, d.distance, d.lo, d.hi,
                                       point_of(d.point_a), point_of(d.point_b), part_of(d.parts.a),
                                       part_of(d.parts.b));
}
py::object answer_of(const std::optional<BodyDistance>& d) {
    return d ? answer_of(*d) : py::none();
}

py::object answer_of(std::vector<BodyContact> contacts) {
    const Owned<BodyContact> held(std::move(contacts));
    return named_tuple("BodyContacts")(held.column<std::uint32_t>(offsetof(BodyContact, bodies), 2),
                                       held.column<double>(offsetof(BodyContact, point), 3),
                                       held.column<double>(offsetof(BodyContact, normal), 3),
                                       held.column<double>(offsetof(BodyContact, depth)),
                                       held.column<std::int32_t>(offsetof(BodyContact, parts), 2));
}

py::array pairs_of(std::vector<Pair> pairs) { return array_of<std::uint32_t>(std::move(pairs), 2); }

AllowedReason reason_of(const std::string& name) {
    for (const AllowedReason reason :
         {AllowedReason::adjacent, AllowedReason::never, AllowedReason::always,
          AllowedReason::default_state, AllowedReason::sampled, AllowedReason::user})
        if (name_of(reason) == name)
            return reason;
    throw py::value_error("reason: adjacent, never, always, default, sampled or user is wanted, "
                          "not '" +
                          name + "'");
}

/// A World of Python: bodies by their numbers or names.
class PyWorld {
  public:
    PyWorld(std::int64_t threads, bool is_timed)
        : world_({.threads = threads_of(threads), .is_timed = is_timed}) {}

    World& world() { return world_; }
    const World& world() const { return world_; }

    std::uint32_t body(const py::object& given) const {
        if (py::isinstance<py::str>(given))
            return world_.find(py::cast<std::string>(given));
        const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
        if (!index)
            throw py::error_already_set();
        const long long number = PyLong_AsLongLong(index.ptr());
        if (number < 0 || number > std::numeric_limits<std::uint32_t>::max())
            throw py::value_error("body " + std::string(py::str(index)) + " is not in the world");
        return static_cast<std::uint32_t>(number);
    }
    std::vector<std::uint32_t> bodies(const py::object& given) const {
        return indices_of(given, "bodies", std::size_t{1} << 32);
    }

    std::uint32_t insert(const py::object& shape, const py::object& pose, const std::string& name,
                         std::uint32_t group, std::uint32_t mask, double margin) {
        return world_.insert(body_shape_of(shape), pose_of(pose, "pose"),
                             {.name = name, .group = group, .mask = mask, .margin = margin});
    }

    py::array pose(const py::object& given) const {
        const auto& [rotation, t] = world_.pose(body(given));
        std::vector<double> m;
        for (int i = 0; i < 3; ++i) {
            const Vec3<double>& row = rotation[static_cast<std::size_t>(i)];
            m.insert(m.end(), {row.x, row.y, row.z, t[i]});
        }
        m.insert(m.end(), {0, 0, 0, 1});
        return array_of<double>(std::move(m)).reshape({4, 4});
    }

    py::object allowed(const py::object& a, const py::object& b) const {
        const auto reason = world_.allowed(body(a), body(b));
        return reason ? py::object(py::str(std::string(name_of(*reason)))) : py::none();
    }

    py::object distances(double tolerance) const {
        const Owned<BodyDistance> held(without_gil([&] { return world_.distances(tolerance); }));
        return named_tuple("BodyDistances")(
            held.column<std::uint32_t>(offsetof(BodyDistance, bodies), 2),
            held.column<double>(offsetof(BodyDistance, distance)),
            held.column<double>(offsetof(BodyDistance, lo)),
            held.column<double>(offsetof(BodyDistance, hi)),
            held.column<double>(offsetof(BodyDistance, point_a), 3),
            held.column<double>(offsetof(BodyDistance, point_b), 3),
            held.column<std::int32_t>(offsetof(BodyDistance, parts), 2));
    }

    py::object contacts(const std::optional<std::size_t>& most) const {
        return answer_of(without_gil([&] { return world_.contacts(at_most(most)); }));
    }
    py::object contacts_between(const py::object& a, const py::object& b,
                                const std::optional<std::size_t>& most) const {
        const std::uint32_t i = body(a), j = body(b);
        return answer_of(without_gil([&] { return world_.contacts(i, j, at_most(most)); }));
    }

    py::object plan() const {
        py::list rows;
        for (const PlannedStage& stage : world_.plan(every_query))
            rows.append(named_tuple("PlannedStage")(stage.name, stage.is_required, stage.why));
        return rows;
    }
    py::object ledger() const {
        const Ledger kept = world_.ledger(every_query);
        py::list rows;
        for (const LedgerRow& row : kept.rows())
            rows.append(
                named_tuple("LedgerRow")(row.stage, row.calls, row.items, row.ns, row.bytes));
        return rows;
    }

    py::object first_contacts(const py::object& bodies_given, const py::object& to,
                              const std::string& path) const {
        const std::vector<std::uint32_t> moving = bodies(bodies_given);
        const std::vector<Pose> poses = poses_of(to, "poses");
        if (moving.size() != poses.size())
            throw py::value_error("poses: there are " + std::to_string(poses.size()) + ", and " +
                                  std::to_string(moving.size()) + " bodies");
        std::vector<BodyMotion> motions;
        for (std::size_t i = 0; i < moving.size(); ++i)
            motions.push_back({moving[i], poses[i], path_of(path)});
        struct Row {
            Pair bodies;
            double t_free, t_hit;
            bool is_certain;
        };
        std::vector<Row> rows;
        for (const auto& [pair, contact] :
             without_gil([&] { return world_.first_contacts(motions); }))
            rows.push_back({pair, contact.t_free, contact.t_hit, contact.hit == Answer::yes});
        const Owned<Row> held(std::move(rows));
        return named_tuple("FirstContacts")(held.column<std::uint32_t>(offsetof(Row, bodies), 2),
                                            held.column<double>(offsetof(Row, t_free)),
                                            held.column<double>(offsetof(Row, t_hit)),
                                            held.column<bool>(offsetof(Row, is_certain)));
    }

  private:
    static constexpr WorldQuery every_query[] = {WorldQuery::candidates, WorldQuery::collide,
                                                 WorldQuery::distance,   WorldQuery::within,
                                                 WorldQuery::contacts,   WorldQuery::first_contact};

    static ContactOptions at_most(const std::optional<std::size_t>& contacts) {
        ContactOptions options;
        options.max_contacts = contacts.value_or(options.max_contacts);
        return options;
    }

    World world_;
};

void add_changes(py::class_<PyWorld>& to) {
    using py::arg;
    using Object = const py::object&;
    to.def("insert", &PyWorld::insert, arg("shape"), arg("pose") = py::none(), py::kw_only(),
           arg("name") = "", arg("group") = 1, arg("mask") = 0xffffffff, arg("margin") = 0.0,
           R"(One more body. Returns its number, by which or by its name it is called.

shape: a Shape, or a Mesh, whose tree is shared.
pose: shape (4, 4), a rotation and a translation; None is no motion.
group, mask: bits; two bodies may meet if each is in a group that the other's
    mask has.
margin: the body is all that is at most so far from its shape.)")
        .def(
            "remove", [](PyWorld& self, Object body) { self.world().remove(self.body(body)); },
            arg("body"), "Its number may be given to a later body.")
        .def(
            "clear", [](PyWorld& self) { self.world().clear(); }, "Removes all bodies.")
        .def(
            "set_pose",
            [](PyWorld& self, Object body, Object pose) {
                self.world().set_pose(self.body(body), pose_of(pose, "pose"));
            },
            arg("body"), arg("pose"),
            "Of one body: its number or name, and shape (4, 4); None is no motion.")
        .def(
            "set_poses",
            [](PyWorld& self, Object bodies, Object poses) {
                self.world().set_poses(self.bodies(bodies), poses_of(poses, "poses"));
            },
            arg("bodies"), arg("poses"), "Of n bodies at once: numbers, and shape (n, 4, 4).")
        .def(
            "set_margin",
            [](PyWorld& self, Object body, double margin) {
                self.world().set_margin(self.body(body), margin);
            },
            arg("body"), arg("margin"), "The body is all that is at most so far from its shape.")
        .def(
            "set_groups",
            [](PyWorld& self, Object body, std::uint32_t group, std::uint32_t mask) {
                self.world().set_groups(self.body(body), group, mask);
            },
            arg("body"), arg("group"), arg("mask"),
            "Bits; two bodies may meet if each is in a group that the other's mask has.")
        .def(
            "allow",
            [](PyWorld& self, Object a, Object b, const std::string& reason,
               const std::string& note) {
                self.world().allow(self.body(a), self.body(b), reason_of(reason), note);
            },
            arg("a"), arg("b"), arg("reason") = "user", arg("note") = "",
            "The two may collide without being reported. reason: adjacent, never, always, "
            "default, sampled or user.")
        .def(
            "disallow",
            [](PyWorld& self, Object a, Object b) {
                self.world().disallow(self.body(a), self.body(b));
            },
            arg("a"), arg("b"), "The two are looked at again: the opposite of allow().")
        .def(
            "update", [](PyWorld& self) { without_gil([&] { self.world().update(); }); },
            "The tree takes in what changed; else the next query has it do so.");
}

void add_looks(py::class_<PyWorld>& to) {
    using py::arg;
    using Object = const py::object&;
    to.def("__len__", [](const PyWorld& self) { return self.world().size(); })
        .def("__contains__",
             [](const PyWorld& self, std::uint32_t body) { return self.world().contains(body); })
        .def("__contains__",
             [](const PyWorld& self, const std::string& name) {
                 return self.world().contains(std::string_view(name));
             })
        .def("__repr__",
             [](const PyWorld& self) {
                 return "<boxwood.World of " + std::to_string(self.world().size()) + " bodies>";
             })
        .def(
            "bodies",
            [](const PyWorld& self) { return array_of<std::uint32_t>(self.world().bodies()); },
            "Their numbers, ascending.")
        .def(
            "find",
            [](const PyWorld& self, const std::string& name) { return self.world().find(name); },
            arg("name"),
            "The number of the body of this name; ValueError, with a suggestion, if there is none.")
        .def("pose", &PyWorld::pose, arg("body"), "Where the body is: shape (4, 4), float64.")
        .def("allowed", &PyWorld::allowed, arg("a"), arg("b"),
             "Why the two may collide; None if they may not.")
        .def(
            "may_meet",
            [](const PyWorld& self, Object a, Object b) {
                return self.world().may_meet(self.body(a), self.body(b));
            },
            arg("a"), arg("b"), "Whether they are looked at: by groups, masks and what is allowed.")
        .def("plan", &PyWorld::plan,
             "PlannedStage of every stage there is, and whether these bodies require it for any "
             "question.")
        .def("ledger", &PyWorld::ledger,
             "LedgerRow of each stage: what it did since the start or clear_ledger().")
        .def(
            "clear_ledger", [](PyWorld& self) { self.world().clear_ledger(); },
            "Calls, items and times count from 0 again.");
}

void add_questions(py::class_<PyWorld>& to) {
    using py::arg;
    using Object = const py::object&;
    to.def(
          "candidates",
          [](const PyWorld& self, double tolerance) {
              return pairs_of(without_gil([&] { return self.world().candidates(tolerance); }));
          },
          arg("tolerance") = 0.0,
          "Pairs that may meet whose boxes are at most `tolerance` apart: shape (m, 2).")
        .def(
            "candidates_of",
            [](const PyWorld& self, Object body, double tolerance) {
                const std::uint32_t i = self.body(body);
                return array_of<std::uint32_t>(
                    without_gil([&] { return self.world().candidates_of(i, tolerance); }));
            },
            arg("body"), arg("tolerance") = 0.0,
            "The bodies that this one may meet, boxes at most `tolerance` apart: shape (n,).")
        .def(
            "collides",
            [](const PyWorld& self, Object a, Object b) {
                const std::uint32_t i = self.body(a), j = self.body(b);
                return without_gil([&] { return self.world().collide(i, j); }) != Answer::no;
            },
            arg("a"), arg("b"),
            "Whether the two share a point, or may within rounding; whether or not they may meet.")
        .def(
            "distance",
            [](const PyWorld& self, Object a, Object b) {
                const std::uint32_t i = self.body(a), j = self.body(b);
                return answer_of(without_gil([&] { return self.world().distance(i, j); }));
            },
            arg("a"), arg("b"), "BodyDistance of the two, whether or not they may meet.")
        .def(
            "signed_distance",
            [](const PyWorld& self, Object a, Object b, double tolerance) {
                const std::uint32_t i = self.body(a), j = self.body(b);
                return answer_of(
                    without_gil([&] { return self.world().signed_distance(i, j, tolerance); }));
            },
            arg("a"), arg("b"), py::kw_only(), arg("tolerance") = 0.0,
            R"(BodyDistance of convex shapes and solids; below 0 they overlap.

Then -distance is how deep: of two convex shapes the least way that parts them,
where one is a solid the farthest that a point of one's surface inside the other
is from the other's. tolerance: how far lo and hi may be apart then (of a solid);
0 is a hundredth of the smaller one's size. Raises ValueError where one is a
surface.)")
        .def(
            "are_within",
            [](const PyWorld& self, Object a, Object b, double tolerance) {
                const std::uint32_t i = self.body(a), j = self.body(b);
                return without_gil([&] { return self.world().within(i, j, tolerance); }) !=
                       Answer::no;
            },
            arg("a"), arg("b"), arg("tolerance"),
            "Whether the two are at most so far apart, or may be within rounding; whether or not "
            "they may meet.")
        .def("contacts_between", &PyWorld::contacts_between, arg("a"), arg("b"), py::kw_only(),
             arg("max_contacts") = py::none(),
             "BodyContacts of the two, the deepest first, whether or not they may meet.")
        .def(
            "collisions",
            [](const PyWorld& self) {
                return pairs_of(without_gil([&] { return self.world().collisions(); }));
            },
            "All pairs that share a point: shape (m, 2), sorted.")
        .def(
            "collisions_of",
            [](const PyWorld& self, Object body) {
                const std::uint32_t i = self.body(body);
                return array_of<std::uint32_t>(
                    without_gil([&] { return self.world().collisions_of(i); }));
            },
            arg("body"), "The bodies that this one touches, ascending: shape (n,), uint32.")
        .def(
            "any_collision",
            [](const PyWorld& self) -> py::object {
                const auto pair = without_gil([&] { return self.world().any_collision(); });
                return pair ? py::object(py::make_tuple(pair->a, pair->b)) : py::none();
            },
            "One of them, or None.")
        .def(
            "least_distance",
            [](const PyWorld& self, double limit, double relative, double absolute) {
                const DistanceOptions options{relative, absolute, std::nullopt, limit};
                return answer_of(without_gil([&] { return self.world().least_distance(options); }));
            },
            arg("limit") = no_limit, py::kw_only(), arg("relative") = 0.0, arg("absolute") = 0.0,
            "BodyDistance of the nearest pair; None from the limit on. It may be farther, and less "
            "is looked at: hi <= (lo + absolute) / (1 - relative).")
        .def(
            "least_distance_of",
            [](const PyWorld& self, Object body, double limit, double relative, double absolute) {
                const std::uint32_t i = self.body(body);
                const DistanceOptions options{relative, absolute, std::nullopt, limit};
                return answer_of(
                    without_gil([&] { return self.world().least_distance_of(i, options); }));
            },
            arg("body"), arg("limit") = no_limit, py::kw_only(), arg("relative") = 0.0,
            arg("absolute") = 0.0,
            "BodyDistance of this body and what is nearest to it; None from the limit on.")
        .def(
            "within",
            [](const PyWorld& self, double tolerance) {
                return pairs_of(without_gil([&] { return self.world().within(tolerance); }));
            },
            arg("tolerance"), "All pairs at most so far apart: shape (m, 2), sorted.")
        .def("distances", &PyWorld::distances, arg("tolerance"),
             "BodyDistances of the pairs at most so far apart.")
        .def("contacts", &PyWorld::contacts, py::kw_only(), arg("max_contacts") = py::none(),
             "BodyContacts, pair by pair, in each the deepest first. max_contacts: of each pair.")
        .def("first_contacts", &PyWorld::first_contacts, arg("bodies"), arg("poses"),
             arg("path") = "linear",
             R"(FirstContacts of bodies on their way, the earliest first.

bodies, poses: those that move while t goes from 0 to 1, and where to; shape
    (n,) and (n, 4, 4). path: linear, or screw.)");
}

} // namespace

void add_worlds(py::module_& to) {
    add_shapes(to);
    py::class_<PyWorld> world(
        to, "World", R"(Bodies that come, go and move, and questions about those that may meet.

A tree of their boxes finds candidates, then shapes decide: exactly of meshes,
between proven bounds of convex shapes; what is within rounding counts as yes.
Queries may come from any number of threads at once (the GIL is released); who
changes the world is alone with it meanwhile. A body that is not there raises
ValueError.)");
    refuse_copies(world);
    world.def(py::init<std::int64_t, bool>(), py::kw_only(), py::arg("threads") = 1,
              py::arg("is_timed") = false,
              "threads: of questions about many pairs. is_timed: whether the ledger has times.");
    add_changes(world);
    add_looks(world);
    add_questions(world);
}

} // namespace boxwood::python
