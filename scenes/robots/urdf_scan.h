#pragma once

#include "kernels/kinematics/robot_description.h"
#include "scenes/robots/xml_reader.h"

#include <string>
#include <vector>

namespace boxwood {

/// A URDF file as liburdfdom is to read it, and what that would not tell.
struct UrdfScan {
    std::string name;
    /// Links and joints by their names and ties; of geometries the kinds alone, and of meshes and
    /// capsules, which liburdfdom does not know, all.
    RobotDescription outline;
    /// Of each mesh, in the order in which the links name them: its element and file name.
    struct Mesh {
        const tinyxml2::XMLElement* element;
        std::string file_name;
        std::string link;
    };
    std::vector<Mesh> meshes;
    /// Plain ASCII: link i is called Li, joint j Jj, and nothing is in it but kinematics and sizes.
    std::string plain;
};

/// Looks at a file before liburdfdom does, which names neither file nor line, leaves out a
/// collision element that it cannot read (numbers between tabs, say), keeps no order of links, and
/// whose XML reader overflows the stack on deep files. Throws as read_urdf says.
UrdfScan scan_urdf(const XmlReader& reader);

} // namespace boxwood
