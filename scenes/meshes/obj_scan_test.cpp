#include "kernels/testing/complaint.h"
#include "scenes/meshes/mesh_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string with_face(const std::string& face) {
    return scan_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + face + "\n");
}

TEST(ScanObj, CornersOfAnyFormAreRead) {
    for (const char* face : {"1/1/1 2//2 3/", "1 2/1 3//"})
        EXPECT_EQ(with_face(face), with_face("1 2 3")) << face;
}

TEST(ScanObj, WhatIsNoCornerIsNamedWithItsLine) {
    for (const std::string corner : {"3/x", "3/1/1/1", "3/1.5", "3,1"})
        EXPECT_THAT(complaint_of<MeshError>([&] { with_face("1/1/1 2//2 " + corner); }),
                    AllOf(HasSubstr("line 4"), HasSubstr(corner)));
}

} // namespace
} // namespace boxwood
