#include "bench/commands/list.h"

#include "bench/commands/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(List, EveryCatalogueStandsInTheWhole) {
    const std::string text = list_catalogues("", false), json = list_catalogues("", true);
    for (const std::string_view name : catalogue_names()) {
        EXPECT_THAT(text, HasSubstr(std::string(name) + ": "));
        EXPECT_THAT(json, HasSubstr("\"" + std::string(name) + "\":["));
    }
}

TEST(List, OneCatalogueHasALinePerEntry) {
    EXPECT_THAT(list_catalogues("executors", false), HasSubstr("serial"));
    EXPECT_THAT(list_catalogues("executors", true),
                StartsWith("[{\"name\":\"serial\",\"summary\":"));
    EXPECT_THAT(list_catalogues("tasks", false), HasSubstr("rays_closest"));
    EXPECT_THAT(list_catalogues("kernels", true), HasSubstr("\"name\":\"watertight\""));
}

TEST(List, ARungSaysPromiseBoundAndCost) {
    const std::string text = list_catalogues("kernels", false);
    EXPECT_THAT(text, HasSubstr("triangle_triangle, exact: "));
    EXPECT_THAT(text, HasSubstr("bound: "));
    EXPECT_THAT(text, HasSubstr("cost: rational: microseconds, allocates"));
    EXPECT_THAT(text, HasSubstr("vertex_face, exact: "));
    const std::string json = list_catalogues("kernels", true);
    EXPECT_THAT(json, HasSubstr(R"("family":"triangle_triangle","promise":"certified","bound":)"));
}

TEST(List, AFamilySaysItsPanelAndItsParameters) {
    const std::string text = list_catalogues("families", false);
    EXPECT_THAT(text, HasSubstr("degenerate: triangles of two planes at an angle of 10^-k"));
    EXPECT_THAT(text, HasSubstr("k = 16 (1 to 18): the angle is 10^-k"));
    EXPECT_THAT(text, HasSubstr("scale = -860 to 860 ("));
    const std::string json = list_catalogues("families", true);
    EXPECT_THAT(json, HasSubstr(R"("panel":"degenerate","k":{"meaning":"the angle is 10^-k",)"
                                R"("default":16,"least":1,"most":18},)"
                                R"("scale":{"least":-860,"most":860},"reads_file":false})"));
    EXPECT_THAT(json, HasSubstr(R"("k":null)"));
    EXPECT_THAT(json, HasSubstr(R"("reads_file":true)"));
}

TEST(List, AMisspeltNameGetsASuggestion) {
    try {
        list_catalogues("bilders", false);
        FAIL();
    } catch (const BadInput& e) {
        EXPECT_THAT(e.what(), HasSubstr("'builders'"));
    }
}

} // namespace
} // namespace boxwood::bench
