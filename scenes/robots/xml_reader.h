#pragma once

#include "kernels/primitives/vec3.h"

#include <tinyxml2.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace boxwood {

/// Reads typed attributes out of an XML file whose root is <robot>. What is wrong throws
/// std::runtime_error with its place: "file:line: what is wrong and what is wanted".
class XmlReader {
  public:
    /// `kind`: URDF or SRDF, for messages. Throws for text that is no well-formed XML.
    XmlReader(std::string_view text, std::string source, std::string_view kind);

    const tinyxml2::XMLElement& robot() const { return *robot_; }
    const std::string& source() const { return source_; }
    std::string place(const tinyxml2::XMLElement& at) const;
    [[noreturn]] void fail(const tinyxml2::XMLElement& at, const std::string& what) const;

    /// An attribute that must be there, and not empty.
    std::string text(const tinyxml2::XMLElement& of, const char* attribute) const;
    /// The child element of that name; there must be one.
    const tinyxml2::XMLElement& child(const tinyxml2::XMLElement& of, const char* name) const;
    /// A finite number; `fallback` without the attribute.
    double number(const tinyxml2::XMLElement& of, const char* attribute) const;
    double number(const tinyxml2::XMLElement& of, const char* attribute, double fallback) const;
    /// Three finite numbers between blanks.
    Vec3<double> vector(const tinyxml2::XMLElement& of, const char* attribute) const;
    Vec3<double> vector(const tinyxml2::XMLElement& of, const char* attribute,
                        Vec3<double> fallback) const;
    /// The index of a name. What there is instead is suggested.
    std::size_t index(const tinyxml2::XMLElement& of, const char* attribute, std::string_view what,
                      std::span<const std::string_view> known) const;

  private:
    tinyxml2::XMLDocument document_;
    const tinyxml2::XMLElement* robot_ = nullptr;
    std::string source_;
};

/// Each child element of that name, in order; of any name if it is null.
template <class Take>
void for_each_child(const tinyxml2::XMLElement& of, const char* name, Take take) {
    for (const auto* e = of.FirstChildElement(name); e; e = e->NextSiblingElement(name))
        take(*e);
}

} // namespace boxwood
