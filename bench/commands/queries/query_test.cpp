#include "bench/commands/queries/query.h"

#include "bench/commands/command.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;

/// Files in a folder of their own.
class Query : public ::testing::Test {
  protected:
    Query()
        : folder_(std::filesystem::temp_directory_path() /
                  ("boxwood_query_" + std::to_string(std::random_device{}()))) {
        std::filesystem::create_directories(folder_);
    }
    ~Query() override { std::filesystem::remove_all(folder_); }

    std::string put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    template <class Q> static std::string answer(const Q& query) {
        std::ostringstream out;
        run(query, out);
        return out.str();
    }
    template <class Q> static std::string complaint(const Q& query) {
        try {
            return "answered: " + answer(query);
        } catch (const BadInput& e) {
            return e.what();
        }
    }
    PairsQuery pairs(const std::string& text) const {
        PairsQuery query;
        query.boxes = put("boxes.csv", text);
        return query;
    }

    std::filesystem::path folder_;
};

using QueryPairs = Query;

TEST_F(QueryPairs, TouchingIdenticalAndFlatBoxesArePairs) {
    const std::string text = "0,0,0,1,1,1\n1,1,1,2,2,2\n5,5,5,6,6,6\n5,5,5,6,6,6\n1,0,0,1,9,9\n";
    EXPECT_EQ(answer(pairs(text)), "0,1\n0,4\n1,4\n2,3\n");
}

TEST_F(QueryPairs, ManyFormats) {
    PairsQuery query = pairs("0,0,0,1,1,1\n1,1,1,2,2,2\n0x1p-1,.5,5e-1,1,1,1\n");
    query.count = true;
    EXPECT_EQ(answer(query), "3\n");
    query.format.header = true;
    EXPECT_EQ(answer(query), "count\n3\n");
    query.count = false;
    EXPECT_EQ(answer(query), "i,j\n0,1\n0,2\n1,2\n");
}

TEST_F(QueryPairs, NoneAndOne) {
    PairsQuery query = pairs("# no boxes\n");
    EXPECT_EQ(answer(query), "");
    query.format.json = true;
    EXPECT_EQ(answer(query), "{\"boxes\":0,\"count\":0,\"pairs\":[]}\n");
    query = pairs("0,0,0,1,1,1\n");
    EXPECT_EQ(answer(query), "");
    query.count = true;
    EXPECT_EQ(answer(query), "0\n");
}

TEST_F(QueryPairs, TruthIsInDouble) {
    // Equal as floats, apart or touching as doubles; beyond the floats; below the floats.
    EXPECT_EQ(answer(pairs("0,0,0,1,1,1\n1.00000000001,0,0,2,1,1\n")), "");
    EXPECT_EQ(answer(pairs("0,0,0,1.00000000001,1,1\n1.00000000001,0,0,2,1,1\n")), "0,1\n");
    EXPECT_EQ(answer(pairs("1e300,0,0,2e300,1,1\n3e300,0,0,4e300,1,1\n"
                           "-1e300,0,0,1e300,1,1\n-1e301,0,0,-9e300,1,1\n")),
              "0,2\n");
    EXPECT_EQ(answer(pairs("0,0,0,1e-320,1,1\n2e-320,0,0,1,1,1\n1e-320,0,0,3e-320,1,1\n")),
              "0,2\n1,2\n");
}

TEST_F(QueryPairs, EveryChoiceGivesTheSame) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1, 1), size(0, .3);
    std::vector<Aabb<double>> boxes(500);
    std::string text, expected;
    for (auto& [low, high] : boxes) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = place(random);
            high[axis] = low[axis] + size(random);
        }
        char row[256];
        std::snprintf(row, sizeof row, "%a,%.17g,%a,%.17g,%a,%a\n", low.x, low.y, low.z, high.x,
                      high.y, high.z);
        text += row;
    }
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = i + 1; j < boxes.size(); ++j)
            if (overlaps(boxes[i], boxes[j]))
                expected += std::to_string(i) + "," + std::to_string(j) + "\n";
    ASSERT_GT(expected.size(), 1000u);
    PairsQuery query = pairs(text);
    for (const BuilderEntry& builder : builders())
        for (const LayoutEntry& layout : layouts())
            for (const ExecutorEntry& executor : executors())
                for (const unsigned threads : {1u, 3u}) {
                    if (threads > executor.max_threads)
                        continue;
                    query.tree = {std::string(builder.name), std::string(layout.name),
                                  std::string(executor.name), threads};
                    EXPECT_EQ(answer(query), expected)
                        << builder.name << " " << layout.name << " " << executor.name;
                }
}

TEST_F(QueryPairs, BadRowsAreNamed) {
    EXPECT_THAT(complaint(pairs("0,0,0,1,1,1\n\nnan,0,0,1,1,1\n")),
                HasSubstr("boxes.csv:3: min_x is nan"));
    EXPECT_THAT(complaint(pairs("0,0,0,1,inf,1\n")), HasSubstr(":1: max_y is inf"));
    EXPECT_THAT(complaint(pairs("0,0,2,1,1,1\n")),
                HasSubstr(":1: min_z 2 is larger than max_z 1; swap them"));
    EXPECT_THAT(complaint(pairs("0,0,0,1,1\n")), HasSubstr(":1: 5 columns, expected 6"));
}

TEST_F(QueryPairs, BadWordsGetASuggestion) {
    PairsQuery query = pairs("");
    query.tree.builder = "medain";
    EXPECT_THAT(complaint(query), HasSubstr("'median'"));
    query.tree = {};
    query.tree.layout = "wyde8";
    EXPECT_THAT(complaint(query), HasSubstr("'wide8'"));
    query.tree = {};
    query.tree.executor = "tbbb";
    EXPECT_THAT(complaint(query), HasSubstr("'tbb'"));
}

class QueryRaysOnASquare : public Query {
  protected:
    RaysQuery rays(const std::string& text) const {
        RaysQuery query;
        query.mesh = put("square.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3\nf 1 3 4\n");
        query.rays = put("rays.csv", text);
        return query;
    }
};

TEST_F(QueryRaysOnASquare, HitsMissesAndLimits) {
    RaysQuery query = rays("1.5,.5,-1,0,0,1\n.5,1.5,4,0,0,-2\n3,3,-1,0,0,1\n"
                           "1.5,.5,-1,0,0,1,0.5\n1.5,.5,-1,0,0,1,inf\n");
    // u and v are the weights of the second and third corner.
    EXPECT_EQ(answer(query), "0,1,0.5,0.25\n1,2,0.25,0.5\nmiss\nmiss\n0,1,0.5,0.25\n");
    query.any = true;
    EXPECT_EQ(answer(query), "1\n1\n0\n0\n1\n");
    query.format.header = true;
    EXPECT_EQ(answer(query), "hit\n1\n1\n0\n0\n1\n");
    query.format = {.header = false, .json = true};
    EXPECT_EQ(answer(query), "{\"rays\":5,\"hits\":3,\"answers\":[1,1,0,0,1]}\n");
    query.any = false;
    EXPECT_THAT(answer(query), HasSubstr("[{\"triangle\":0,\"t\":1,\"u\":0.5,\"v\":0.25},{"));
    EXPECT_THAT(answer(query), HasSubstr(",null,null,{"));
}

TEST_F(QueryRaysOnASquare, BadRaysAreNamed) {
    EXPECT_THAT(complaint(rays("# a\n0,0,0,0,-0,0\n")), HasSubstr("rays.csv:2: the direction"));
    EXPECT_THAT(complaint(rays("0,0,0,1e-60,0,0\n")), HasSubstr("zero as floats"));
    EXPECT_THAT(complaint(rays("0,nan,0,1,0,0\n")), HasSubstr(":1: oy is nan"));
    EXPECT_THAT(complaint(rays("0,0,0,1e39,0,0\n")), HasSubstr(":1: dx is 1e+39"));
    EXPECT_THAT(complaint(rays("0,0,0,1,0,0,-1\n")), HasSubstr(":1: tmax is -1"));
    EXPECT_THAT(complaint(rays("0,0,0,1,0,0,nan\n")), HasSubstr(":1: tmax is nan"));
    EXPECT_THAT(complaint(rays("0,0,0,1,0\n")), HasSubstr("5 columns, expected 6 to 7"));
}

TEST_F(QueryRaysOnASquare, AMeshBeyondTheRangeOfTheKernelsIsRefused) {
    RaysQuery query = rays("0,0,-1,0,0,1\n");
    query.mesh = put("far.obj", "v 0 0 0\nv 2e38 0 0\nv 0 2 0\nf 1 2 3\n");
    EXPECT_THAT(complaint(query),
                ::testing::AllOf(HasSubstr("far.obj has a vertex at (2e+38, 0, 0)"),
                                 HasSubstr("below 2^126")));
}

TEST_F(QueryRaysOnASquare, EveryKernelAnswersTheSameAndNothingBeyondTmax) {
    // At t = 1 with a tmax whose nearest float is 1; at t = 1e43, where no float is.
    for (const std::string_view kernel :
         {"moller_trumbore_f32", "baldwin_weber_f32", "plucker_f32", "watertight",
          "moller_trumbore_f64", "exact", "rational"}) {
        RaysQuery query = rays("1.5,.5,-1,0,0,1,0.9999999999\n1.5,.5,-1,0,0,1,1.0000000001\n"
                               "1.5,.5,-10,0,0,1e-42\n1.5,.5,0,1,0,0\n");
        query.kernel = kernel;
        EXPECT_EQ(answer(query), "miss\n0,1,0.5,0.25\nmiss\nmiss\n") << kernel;
        query.any = true;
        EXPECT_EQ(answer(query), "0\n1\n0\n0\n") << kernel;
    }
}

TEST_F(QueryRaysOnASquare, APrintedTIsATmaxThatHitsAgain) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> at(.1f, 1.9f), slope(-.1f, .1f), height(.1f, 9);
    std::vector<std::string> rows;
    for (int i = 0; i < 300; ++i)
        rows.push_back(fmt::format("{},{},{},{},{},1", at(random), at(random), -height(random),
                                   slope(random), slope(random)));
    std::vector<std::string_view> kernels = names_of(ray_kernels());
    kernels.push_back("rational");
    const auto lines_of = [](const std::string& text) {
        std::vector<std::string> lines;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);)
            lines.push_back(line);
        return lines;
    };
    const auto t_of = [](const std::string& line) {
        const std::size_t from = line.find(',') + 1;
        return line.substr(from, line.find(',', from) - from);
    };
    for (const std::string_view kernel : kernels) {
        SCOPED_TRACE(kernel);
        std::string text;
        for (const std::string& row : rows)
            text += row + "\n";
        RaysQuery query = rays(text);
        query.kernel = kernel;
        const std::vector<std::string> all = lines_of(answer(query));
        // The exact ones compare the true t, which may be above the printed one by a rounding.
        const bool is_exact = kernel == "exact" || kernel == "rational";
        std::string again;
        std::vector<double> limits;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            std::string limit = all[i] == "miss" ? "9" : t_of(all[i]);
            if (is_exact)
                limit = fmt::format("{:a}", std::nextafter(std::stof(limit), 99.f));
            again += rows[i] + "," + limit + "\n";
            limits.push_back(std::stod(limit));
        }
        query = rays(again);
        query.kernel = kernel;
        const std::vector<std::string> limited = lines_of(answer(query));
        EXPECT_EQ(limited, all);
        EXPECT_GT(std::ranges::count_if(all, [](const auto& line) { return line != "miss"; }), 200);
        for (std::size_t i = 0; i < limited.size(); ++i)
            if (limited[i] != "miss") {
                EXPECT_LE(std::stod(t_of(limited[i])), limits[i]);
            }
    }
}

TEST_F(QueryRaysOnASquare, NoRaysAndUnknownKernel) {
    RaysQuery query = rays("");
    EXPECT_EQ(answer(query), "");
    query.kernel = "watertigth";
    EXPECT_THAT(complaint(query), HasSubstr("'watertight'"));
}

TEST(BlockWriter, WritesAllInOrder) {
    std::ostringstream out;
    std::string expected;
    {
        BlockWriter writer(out);
        for (std::uint32_t i = 0; i < 400'000; ++i) {
            writer << i << ",";
            expected += std::to_string(i) + ",";
        }
        writer << 0.1f;
    }
    EXPECT_EQ(out.str(), expected + "0.1");
}

} // namespace
} // namespace boxwood::bench
