#include "bench/commands/queries/bodies.h"

#include "bench/io/bad_input.h"
#include "kernels/primitives/coordinate_limit.h"
#include "kernels/suggest.h"
#include "scenes/text/csv.h"
#include "scenes/text/fields.h"
#include "scenes/text/number.h"
#include "scenes/text/read_file.h"
#include "trees/world/box_mesh.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

namespace boxwood::bench {
namespace {

/// What follows the name of a form.
struct Given {
    std::span<const double> numbers;
    std::string file; ///< of a form that ends with one
    const BodyReading& how;
};

BodyShape hull_of_file(const Given& given) {
    const TriangleMesh mesh = read_user_mesh(given.file, given.how.bad_triangles, false).mesh;
    std::vector<Vec3<double>> points;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            points.emplace_back(mesh.vertices[vertex]);
    const auto key = [](const Vec3<double>& p) { return std::tuple(p.x, p.y, p.z); };
    std::ranges::sort(points, {}, key);
    points.erase(std::ranges::unique(points, {}, key).begin(), points.end());
    return BodyShape::hull(std::move(points));
}

float finite_float(double x, const std::string& file, std::size_t line) {
    const auto rounded = static_cast<float>(x);
    if (!std::isfinite(rounded))
        throw_bad_row(file, line, fmt::format("{} is no finite float", x));
    return rounded;
}

BodyShape points_of_file(const Given& given) {
    std::vector<Vec3<float>> points;
    const auto take = [&](std::span<const double> row, std::size_t line) {
        Vec3<float>& point = points.emplace_back();
        for (int axis = 0; axis < 3; ++axis)
            point[axis] = finite_float(row[static_cast<std::size_t>(axis)], given.file, line);
    };
    if (read_csv(read_file(given.file), given.file, {"x,y,z", 3, 3}, take) == 0)
        throw BadInput(given.file + ": there is no point");
    return BodyShape::points(points, given.numbers[0]);
}

/// As many numbers in a row as there are, which read_csv does not take.
BodyShape heights_of_file(const Given& given) {
    const std::string all = read_file(given.file);
    std::string_view text = without_byte_order_mark(all);
    std::vector<float> heights;
    std::size_t columns = 0;
    for (std::size_t line = 1; !text.empty(); ++line) {
        std::string_view row = trimmed(take_until(text, '\n'));
        if (row.empty() || row.front() == '#')
            continue;
        std::size_t n = 0;
        for (bool more = true; more; ++n) {
            more = row.find(',') != std::string_view::npos;
            double height = 0;
            const std::string_view field = trimmed(take_until(row, ','));
            if (parse_number(field, height) != NumberFault::none)
                throw_bad_row(
                    given.file, line,
                    fmt::format("column {} is {}, which is no height", n + 1, quoted(field)));
            heights.push_back(finite_float(height, given.file, line));
        }
        if (columns != 0 && n != columns)
            throw_bad_row(given.file, line,
                          fmt::format("{} heights; the rows before have {}", n, columns));
        columns = n;
    }
    return BodyShape::height_field(columns, heights, static_cast<float>(given.numbers[0]),
                                   static_cast<float>(given.numbers[1]));
}

/// A form of a body, NAME:NUMBERS, NAME:FILE or NAME:NUMBERS,FILE.
struct Form {
    std::string_view name;
    std::size_t numbers;
    std::string_view form;
    BodyShape (*make)(const Given&);
    bool has_file = false;
    bool are_lengths = true; ///< the numbers are at least 0
};

constexpr Form forms[] = {
    {"box", 3, "box:x,y,z, its full side lengths",
     [](const Given& g) -> BodyShape {
         return convex::Box{{g.numbers[0] / 2, g.numbers[1] / 2, g.numbers[2] / 2}};
     }},
    {"sphere", 1, "sphere:radius",
     [](const Given& g) -> BodyShape { return convex::Sphere{g.numbers[0]}; }},
    {"capsule", 2, "capsule:radius,length, the length without the round ends",
     [](const Given& g) -> BodyShape {
         return convex::Capsule{g.numbers[0], g.numbers[1] / 2};
     }},
    {"cylinder", 2, "cylinder:radius,length",
     [](const Given& g) -> BodyShape {
         return convex::Cylinder{g.numbers[0], g.numbers[1] / 2};
     }},
    {"cone", 2, "cone:radius,length, its tip up, the middle of its axis at the origin",
     [](const Given& g) -> BodyShape {
         return convex::Cone{g.numbers[0], g.numbers[1] / 2};
     }},
    {"ellipsoid", 3, "ellipsoid:x,y,z, its radii",
     [](const Given& g) -> BodyShape {
         return convex::Ellipsoid{{g.numbers[0], g.numbers[1], g.numbers[2]}};
     }},
    {"half_space", 4, "half_space:x,y,z,offset, the points p with (x,y,z) . p <= offset",
     [](const Given& g) -> BodyShape {
         return convex::HalfSpace{{g.numbers[0], g.numbers[1], g.numbers[2]}, g.numbers[3]};
     },
     false, false},
    {"plane", 4, "plane:x,y,z,offset, the points p with (x,y,z) . p = offset",
     [](const Given& g) -> BodyShape {
         return convex::Plane{{g.numbers[0], g.numbers[1], g.numbers[2]}, g.numbers[3]};
     },
     false, false},
    {"hull", 0, "hull:FILE, the convex hull of a mesh file", hull_of_file, true},
    {"points", 1, "points:radius,FILE, balls about the points of a CSV file of rows x,y,z",
     points_of_file, true},
    {"height_field", 2,
     "height_field:step_x,step_y,FILE, of a CSV file: in row j and column i the height at i "
     "step_x, "
     "j step_y",
     heights_of_file, true},
};

/// The form of a text; none of a mesh file, which may have any name.
const Form* form_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        return nullptr;
    std::string name = text.substr(0, colon);
    std::ranges::replace(name, '-', '_');
    const auto form = std::ranges::find(forms, std::string_view(name), &Form::name);
    if (form != std::ranges::end(forms))
        return form;
    const bool is_word =
        std::ranges::all_of(name, [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
    if (is_word && name.size() > 1 && !std::filesystem::exists(text))
        throw BadInput(fmt::format("{}: no such file, and {}", text,
                                   unknown_name("shape", name, names_of(forms))));
    return nullptr;
}

/// The numbers of a form, and its file.
std::pair<std::vector<double>, std::string> arguments(const std::string& text, const Form& form) {
    std::string_view rest = std::string_view(text).substr(text.find(':') + 1);
    std::vector<double> numbers;
    const auto take = [&](std::span<const double> row, std::size_t) {
        numbers.assign(row.begin(), row.end());
    };
    std::string row;
    for (std::size_t i = 0; form.has_file && i < form.numbers; ++i)
        (row += i ? "," : "") += take_until(rest, ',');
    const std::string_view of_numbers = form.has_file ? std::string_view(row) : rest;
    const bool has_all =
        form.numbers == 0 ||
        read_csv(of_numbers, text, {form.form, form.numbers, form.numbers}, take) == 1;
    if (!has_all || (form.has_file && rest.empty()))
        throw BadInput(fmt::format("{}: it is {}", text, form.form));
    for (const double x : numbers) {
        if (form.are_lengths && !(x >= 0 && x < coordinate_limit))
            throw BadInput(
                fmt::format("{}: a length is {}; it must be at least 0 and finite", text, x));
        if (!std::isfinite(x))
            throw BadInput(fmt::format("{}: {} is not finite", text, x));
    }
    return {numbers, form.has_file ? std::string(rest) : ""};
}

/// make(), with the name of the body before what is wrong with it.
template <class Make> auto named(const std::string& body, const Make& make) {
    try {
        return make();
    } catch (const BadInput&) {
        throw;
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("{}: {}", body, error.what()));
    }
}

NamedBody body_of_file(const std::string& file, const BodyReading& how, QueryTimes& times) {
    UserMesh read =
        times.reading([&] { return read_user_mesh(file, how.bad_triangles, how.is_solid); });
    MeshTreeOptions tree;
    tree.volume = how.volume;
    NamedBody body{times.building([&] {
                       return how.is_solid ? BodyShape::solid(std::move(read.mesh), tree)
                                           : BodyShape::surface(std::move(read.mesh), tree);
                   }),
                   {},
                   std::move(read.numbers)};
    return body;
}

NamedBody body_of_form(const std::string& text, const Form& form, bool box_is_surface,
                       const BodyReading& how, QueryTimes& times) {
    const auto [numbers, file] = arguments(text, form);
    NamedBody body{times.reading([&, &numbers = numbers, &file = file] {
        return form.make({numbers, file, how});
    })};
    if (body.shape.shape_class() != ShapeClass::convex || !box_is_surface)
        return body;
    if (const auto* box = body.shape.convex_shape().get_if<convex::Box>()) {
        body.box = *box;
        TriangleMesh mesh = box_mesh(2.0 * box->half);
        body.shape =
            how.is_solid ? BodyShape::solid(std::move(mesh)) : BodyShape::surface(std::move(mesh));
    }
    return body;
}

} // namespace

std::string body_forms() {
    std::string text = "Bodies: a mesh file (OBJ, PLY, STL, ...), or one of\n";
    for (const Form& form : forms)
        text += fmt::format("  {}\n", form.form);
    return text + "Lengths are along z. A mesh is its surface, and so is a box beside a mesh, a "
                  "height field or a box;\nall else, and a box beside it, is solid.\n\n";
}

bool is_surface_form(const std::string& text) {
    const Form* form = form_of(text);
    return !form || form->name == "box" || form->name == "height_field";
}

NamedBody read_body(const std::string& text, bool box_is_surface, const BodyReading& how) {
    QueryTimes unwanted;
    QueryTimes& times = how.times ? *how.times : unwanted;
    return named(text, [&] {
        const Form* form = form_of(text);
        NamedBody body = form ? body_of_form(text, *form, box_is_surface, how, times)
                              : body_of_file(text, how, times);
        times.building([&] { return body.shape.build(); });
        return body;
    });
}

void add_volume_option(CLI::App& app, MeshVolume& volume) {
    const auto names = names_of(mesh_volumes());
    app.add_option_function<std::string>(
           "--volume",
           [&volume](const std::string& name) {
               volume = entry_named(name, mesh_volumes(), "volume").volume;
           },
           "what encloses the parts of a mesh in its tree, a name of `boxwood list volumes`")
        ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())))
        ->default_str(std::string(mesh_volumes().front().name));
}

double rounding_of_mesh(const convex::Box& box) {
    return length(Vec3<double>(Vec3<float>(box.half)) - box.half) * (1 + 0x1p-40);
}

namespace {

/// Numbers parted by spaces or commas.
std::vector<double> numbers_of(const std::string& text, const std::string& option,
                               const CsvFormat& format) {
    std::string row;
    for (const char c : text) {
        const bool parts = c == ' ' || c == ',' || c == '\t' || c == '\n';
        if (!parts)
            row += c;
        else if (!row.empty() && row.back() != ',')
            row += ',';
    }
    if (!row.empty() && row.back() == ',')
        row.pop_back();
    std::vector<double> numbers;
    const auto take = [&](std::span<const double> all, std::size_t) {
        numbers.assign(all.begin(), all.end());
    };
    if (read_csv(row, option, format, take) == 0)
        throw BadInput(fmt::format("{} is empty; it takes {}", option, format.columns));
    return numbers;
}

Pose pose_of(std::span<const double> matrix, const std::string& option) {
    try {
        return pose_of_matrix(matrix.first<16>());
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("{}: {}", option, error.what()));
    }
}

} // namespace

Pose read_pose(const std::string& text, const std::string& option) {
    if (text.empty())
        return {};
    return pose_of(numbers_of(text, option, {"16 numbers, a 4 x 4 matrix row by row", 16, 16}),
                   option);
}

Pose read_place(const std::string& text, const std::string& option) {
    constexpr const char* form = "x,y,z or 16 numbers, a 4 x 4 matrix row by row, behind the @";
    const std::vector<double> numbers = numbers_of(text, option, {form, 3, 16});
    if (numbers.size() == 16)
        return pose_of(numbers, option);
    if (numbers.size() != 3)
        throw BadInput(fmt::format("{}: {} numbers; it takes {}", option, numbers.size(), form));
    Pose pose;
    pose.translation = {numbers[0], numbers[1], numbers[2]};
    try {
        return checked_pose(pose);
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("{}: {}", option, error.what()));
    }
}

} // namespace boxwood::bench
