#include "bench/replay/recorded_program.h"

#include "results/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace boxwood::bench {
namespace {

/// A table of a recording, whose numbers are read by row.
class Table {
  public:
    Table(const std::filesystem::path& file, std::string name,
          std::span<const std::string_view> columns)
        : file_(file), name_(std::move(name)), names_(columns),
          columns_(results::read_columns(file, name_, columns)) {}

    std::size_t size() const { return columns_[0].size(); }
    double number(std::size_t row, std::size_t column) const { return columns_[column][row]; }
    /// A whole number below `end`.
    double whole(std::size_t row, std::size_t column, double end) const {
        const double value = number(row, column);
        if (!(value >= 0 && value < end && value == std::floor(value)))
            throw std::runtime_error(fmt::format(
                "{}: row {} of {}/{} is {}, which should be a whole number below {}; the recording "
                "is damaged: record again",
                file_.string(), row, name_, names_[column], value, end));
        return value;
    }
    /// The same, with an end of at most 2^64.
    std::uint64_t integer(std::size_t row, std::size_t column, double end) const {
        return static_cast<std::uint64_t>(whole(row, column, end));
    }

  private:
    std::filesystem::path file_;
    std::string name_;
    std::span<const std::string_view> names_;
    std::vector<std::vector<double>> columns_;
};

[[noreturn]] void throw_short(const std::filesystem::path& file, std::string_view table) {
    throw std::runtime_error(fmt::format(
        "{}: its calls need more rows of {} than there are; was the program still running? Close "
        "the recorder first (FclRecorder::close)",
        file.string(), table));
}

constexpr double many = 0x1p32;

/// After its vertices and triangles, which it checks.
void read_geometries(const std::filesystem::path& file, RecordedProgram& program) {
    const Table table(file, "geometries", recording::geometries);
    std::size_t vertex = 0, triangle = 0;
    for (std::size_t row = 0; row < table.size(); ++row) {
        RecordedProgram::Geometry& of = program.geometries.emplace_back();
        of.shape = static_cast<recording::Shape>(
            table.integer(row, 0, static_cast<double>(recording::shape_names.size())));
        for (std::size_t i = 0; i < of.numbers.size(); ++i)
            of.numbers[i] = table.number(row, 1 + i);
        of.first_vertex = vertex;
        of.first_triangle = triangle;
        vertex += of.n_vertices = static_cast<std::size_t>(table.integer(row, 5, many));
        triangle += of.n_triangles = static_cast<std::size_t>(table.integer(row, 6, many));
        of.hash = table.integer(row, 7, many) << 32 | table.integer(row, 8, many);
        if (vertex > program.vertices.size())
            throw_short(file, "vertices");
        if (triangle > program.triangles.size())
            throw_short(file, "triangles");
        for (const auto& corners : program.triangles_of(of))
            for (const std::uint32_t corner : corners)
                if (corner >= of.n_vertices)
                    throw std::runtime_error(
                        fmt::format("{}: a triangle of geometry {} has vertex {} of {}; the "
                                    "recording is damaged: record again",
                                    file.string(), row, corner, of.n_vertices));
    }
}

void read_requests(const std::filesystem::path& file, RecordedProgram& program) {
    const Table requests(file, "requests", recording::requests);
    for (std::size_t row = 0; row < requests.size(); ++row)
        for (std::size_t i = 0; double& number : program.requests.emplace_back())
            number = requests.whole(row, i++, 0x1.8p64); // the greatest size_t is 2^64 as a double
    const Table counts(file, "request_counts", recording::request_counts);
    const auto n_calls = static_cast<double>(program.calls.size()),
               n_requests = static_cast<double>(program.requests.size());
    for (std::size_t row = 0; row < counts.size(); ++row)
        program.request_counts.push_back(
            {static_cast<std::size_t>(counts.integer(row, 0, n_calls)),
             static_cast<std::size_t>(counts.integer(row, 1, n_requests)),
             counts.whole(row, 2, 0x1p53), counts.number(row, 3)});
}

bool is_of_results(const std::filesystem::path& file) try {
    constexpr std::array<std::string_view, 1> number{"cell_id"};
    results::read_columns(file, "cells", number);
    return true;
} catch (const std::runtime_error&) {
    return false;
}

Table format_of(const std::filesystem::path& file) try {
    return {file, "format", recording::format};
} catch (const std::runtime_error&) {
    if (!is_of_results(file))
        throw;
    throw std::runtime_error(fmt::format("{} is a result file, for `boxwood show`; `boxwood "
                                         "record` and recorders write recordings",
                                         file.string()));
}

} // namespace

RecordedProgram read_program(const std::filesystem::path& file) {
    RecordedProgram program;
    const Table format = format_of(file);
    const double version = format.size() == 1 ? format.number(0, 0) : 0;
    if (version != 1 && version != recording::version)
        throw std::runtime_error(
            fmt::format("{}: no recording of version 1 to {}; record the program again with this "
                        "boxwood",
                        file.string(), recording::version));
    program.bits = format.number(0, 1) == 32 ? 32 : 64;

    const Table vertices(file, "vertices", recording::vertices);
    for (std::size_t row = 0; row < vertices.size(); ++row)
        program.vertices.push_back(
            {vertices.number(row, 0), vertices.number(row, 1), vertices.number(row, 2)});
    const Table triangles(file, "triangles", recording::triangles);
    for (std::size_t row = 0; row < triangles.size(); ++row)
        for (auto& triangle = program.triangles.emplace_back(); std::size_t i : {0u, 1u, 2u})
            triangle[i] = static_cast<std::uint32_t>(triangles.integer(row, i, many));
    read_geometries(file, program);
    const Table objects(file, "objects", recording::objects);
    const auto n_geometries = static_cast<double>(program.geometries.size());
    for (std::size_t row = 0; row < objects.size(); ++row)
        program.geometry_of.push_back(
            static_cast<std::uint32_t>(objects.integer(row, 0, n_geometries)));

    const auto n_objects = static_cast<double>(program.n_objects());
    const Table states(file, "states", recording::states);
    for (std::size_t row = 0; row < states.size(); ++row) {
        RecordedProgram::State& state = program.states.emplace_back();
        state.object = static_cast<std::uint32_t>(states.integer(row, 0, n_objects));
        for (std::size_t i = 0; i < 6; ++i)
            state.bounds[i] = states.number(row, 1 + i);
        for (std::size_t i = 0; i < 12; ++i)
            state.pose[i] = states.number(row, 7 + i);
    }
    const Table of_calls(file, "call_objects", recording::call_objects);
    for (std::size_t row = 0; row < of_calls.size(); ++row)
        program.call_objects.push_back(
            static_cast<std::uint32_t>(of_calls.integer(row, 0, n_objects)));

    const Table calls(file, "calls", recording::calls);
    std::size_t object = 0, state = 0;
    std::vector<char> has_state(program.n_objects(), 0);
    for (std::size_t row = 0; row < calls.size(); ++row) {
        RecordedProgram::Call& call = program.calls.emplace_back();
        call.what = static_cast<recording::Call>(
            calls.integer(row, 0, static_cast<double>(recording::call_names.size())));
        call.first_object = object;
        call.first_state = state;
        object += call.n_objects = static_cast<std::size_t>(calls.integer(row, 1, many));
        state += call.n_states = static_cast<std::size_t>(calls.integer(row, 2, many));
        if (object > program.call_objects.size())
            throw_short(file, "call_objects");
        if (state > program.states.size())
            throw_short(file, "states");
        for (const RecordedProgram::State& of : program.states_of(call))
            has_state[of.object] = 1;
        for (const std::uint32_t added : program.objects_of(call))
            if (call.what == recording::Call::add && !has_state[added])
                throw std::runtime_error(
                    fmt::format("{}: call {} registers object {}, whose bounds are nowhere; the "
                                "recording is damaged: record again",
                                file.string(), row, added));
        call.shown = calls.integer(row, 3, 0x1p53);
        call.keys = calls.integer(row, 4, 0x1p52);
        call.ended = calls.number(row, 5) != 0;
        call.min_distance = calls.number(row, 6);
        call.ns = calls.number(row, 7);
    }
    if (version > 1)
        read_requests(file, program);
    program.touch = most_frequent_touch(program);
    return program;
}

namespace {

bool are_near(std::span<const double> numbers) {
    return std::ranges::all_of(numbers, [](double x) { return std::abs(x) <= 1e18; });
}

} // namespace

bool RecordedProgram::has_near_bounds() const {
    return std::ranges::all_of(states, [](const State& of) { return are_near(of.bounds); });
}

bool RecordedProgram::has_near_poses() const {
    return std::ranges::all_of(states, [](const State& of) { return are_near(of.pose); });
}

RecordedProgram::Touch most_frequent_touch(const RecordedProgram& program) {
    double without = 0, with = 0;
    std::map<double, double> times; // of those with contacts, by max_contacts
    for (const RecordedProgram::RequestCount& row : program.request_counts) {
        const auto [question, max_contacts, contacts, points, is_signed] =
            program.requests[row.request];
        if (question == 0 && contacts != 0) {
            with += row.n;
            times[max_contacts] += row.n;
        } else if (question == 0) {
            without += row.n;
        }
    }
    if (with == 0 || with < without)
        return {};
    const double usual =
        std::ranges::max_element(times, {}, [](const auto& entry) { return entry.second; })->first;
    // Programs ask for all contacts by the greatest number there is.
    return {static_cast<std::size_t>(std::clamp(usual, 1., 1e9)), true};
}

} // namespace boxwood::bench
