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
    EXPECT_THAT(list_catalogues("asks", false), HasSubstr("rays_closest"));
    EXPECT_THAT(list_catalogues("kernels", true), HasSubstr("\"name\":\"watertight\""));
}

TEST(List, EmptyCataloguesSaySo) {
    EXPECT_EQ(list_catalogues("effects", true), "[]\n");
    EXPECT_EQ(list_catalogues("families", true), "[]\n");
    EXPECT_THAT(list_catalogues("effects", false), HasSubstr("none yet"));
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
