#include "trees/triangle_boxes.h"

#include "trees/testing/every_executor.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace boxwood {
namespace {

TEST(TriangleBoxes, AreThoseOfTheTrianglesOnEveryExecutor) {
    const TriangleMesh mesh = triangle_soup(10'000);
    for (const auto& [name, executor] : every_executor()) {
        const Buffer<Box> boxes = triangle_boxes(mesh, *executor);
        ASSERT_EQ(boxes.size(), mesh.triangles.size()) << name;
        for (std::size_t i = 0; i < boxes.size(); ++i)
            ASSERT_EQ(boxes[i], mesh.triangle(i).bounds()) << name << " " << i;
    }
    EXPECT_TRUE(triangle_boxes({}, serial()).empty());
}

TEST(TriangleBoxes, NameTheFirstTriangleThatIsNone) {
    for (const auto& [name, executor] : every_executor()) {
        TriangleMesh mesh = triangle_soup(10'000);
        mesh.vertices[3 * 9'000].y = std::numeric_limits<float>::infinity();
        mesh.vertices[3 * 7'000 + 2].x = NAN;
        try {
            triangle_boxes(mesh, *executor);
            FAIL() << name;
        } catch (const InvalidBox& error) {
            EXPECT_EQ(error.index, 7'000u) << name;
        }
        mesh.triangles[5][1] = 30'000;
        EXPECT_THROW(triangle_boxes(mesh, *executor), std::invalid_argument) << name;
    }
}

} // namespace
} // namespace boxwood
