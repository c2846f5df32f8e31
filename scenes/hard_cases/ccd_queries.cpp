#include "scenes/hard_cases/dyadic.h"
#include "scenes/hard_cases/hard_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

namespace boxwood {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, std::size_t line, std::string_view what) {
    throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), line, what));
}

struct Row {
    Vec3<double> point;
    bool touches;
};

Row row_of(std::string_view text, const fs::path& file, std::size_t line) {
    std::array<std::string_view, 7> cells;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (i + 1 == cells.size()))
            refuse(file, line,
                   "not 7 numbers; a row is x,x,y,y,z,z,truth, each coordinate a numerator and a "
                   "denominator");
        cells[i] = text.substr(0, comma);
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    }
    Row row{};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view top = cells[static_cast<std::size_t>(2 * axis)];
        const std::string_view bottom = cells[static_cast<std::size_t>(2 * axis + 1)];
        const std::optional<double> value = dyadic(top, bottom);
        if (!value)
            refuse(file, line,
                   fmt::format("{}/{} is not exactly a double; numerators are integers, "
                               "denominators powers of two",
                               top, bottom));
        row.point[axis] = *value;
    }
    if (cells[6] != "0" && cells[6] != "1")
        refuse(file, line, fmt::format("the truth is '{}'; it must be 0 or 1", cells[6]));
    row.touches = cells[6] == "1";
    return row;
}

/// Eight rows a query: the four points at the start, then at the end.
void read(const fs::path& file, std::vector<MotionCase>& motions) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw std::runtime_error(fmt::format("{}: cannot be opened", file.string()));
    std::string text;
    std::size_t line = 0, n_rows = 0;
    while (std::getline(in, text)) {
        ++line;
        if (text.ends_with('\r'))
            text.pop_back();
        if (text.empty() || text.starts_with('#'))
            continue;
        const Row row = row_of(text, file, line);
        const std::size_t place = n_rows++ % 8;
        if (place == 0)
            motions.push_back({{}, row.touches ? Known::yes : Known::no});
        MotionCase& query = motions.back();
        if ((query.touch == Known::yes) != row.touches)
            refuse(file, line, "the truth differs from that of the query's first row");
        (place < 4 ? query.motion.start : query.motion.end)[place % 4] = row.point;
    }
    if (in.bad())
        throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
    if (n_rows == 0)
        throw std::runtime_error(fmt::format("{}: it holds no query", file.string()));
    if (n_rows % 8 != 0)
        refuse(file, line,
               fmt::format("the last query has {} of 8 rows; is the file cut short?", n_rows % 8));
}

/// The file itself, or all FOLDER/*.csv below a folder, sorted.
std::vector<fs::path> files_of(const fs::path& place, std::string_view folder) {
    if (!fs::exists(place))
        throw std::runtime_error(fmt::format("{}: no such file or folder", place.string()));
    if (!fs::is_directory(place))
        return {place};
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(place)) {
        const fs::path path = fs::absolute(entry.path()).lexically_normal();
        if (path.extension() == ".csv" && path.parent_path().filename() == folder)
            files.push_back(entry.path());
    }
    if (files.empty())
        throw std::runtime_error(
            fmt::format("{}: no *.csv in a folder named {} here or below", place.string(), folder));
    std::ranges::sort(files);
    return files;
}

template <MotionKind kind> Cases queries(const HardCaseSpec& spec, const Random&) {
    MotionCases cases{kind, {}};
    for (const fs::path& file :
         files_of(spec.file, kind == MotionKind::vertex_face ? "vertex-face" : "edge-edge"))
        read(file, cases.motions);
    return cases;
}

} // namespace

HardCaseFamily ccd_queries_vertex_face_family() {
    return {.name = "ccd_queries_vertex_face",
            .summary = "all vertex-face queries of a file, or of the folders vertex-face below one "
                       "(n and seed unused)",
            .panel = Panel::degenerate,
            .reads_file = true,
            .generate = queries<MotionKind::vertex_face>};
}

HardCaseFamily ccd_queries_edge_edge_family() {
    return {.name = "ccd_queries_edge_edge",
            .summary = "all edge-edge queries of a file, or of the folders edge-edge below one "
                       "(n and seed unused)",
            .panel = Panel::degenerate,
            .reads_file = true,
            .generate = queries<MotionKind::edge_edge>};
}

} // namespace boxwood
