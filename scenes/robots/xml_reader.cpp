#include "scenes/robots/xml_reader.h"

#include "kernels/suggest.h"
#include "scenes/text/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boxwood {
namespace {

using Element = tinyxml2::XMLElement;

constexpr std::string_view blanks = " \t\r\n";

/// "node at line ..., in short": tinyxml2's own text holds the line twice and ends in "(null)".
std::string parse_error(const tinyxml2::XMLDocument& document) {
    std::string name = document.ErrorName(); // XML_ERROR_MISMATCHED_ELEMENT
    for (const std::string_view prefix : {"XML_ERROR_", "XML_"})
        if (name.starts_with(prefix))
            name.erase(0, prefix.size());
    for (char& c : name)
        c = c == '_' ? ' ' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return name;
}

/// Takes the next number off the front. What is wrong with it, or empty.
std::string take_number(std::string_view& text, double& number) {
    const std::size_t end = std::min(text.find_first_of(blanks), text.size());
    const std::string_view token = text.substr(0, end);
    text.remove_prefix(end);
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    const bool is_hex =
        token.find_first_of("xX") != std::string_view::npos; // liburdfdom reads none
    switch (is_hex ? NumberFault::not_a_number : parse_number(token, number)) {
    case NumberFault::none:
        break;
    case NumberFault::too_large:
        return fmt::format("'{}' is beyond the range of a double", token);
    case NumberFault::not_a_number:
        return fmt::format("'{}' is no number", token);
    }
    if (!std::isfinite(number))
        return fmt::format("'{}' is not finite", token);
    return {};
}

} // namespace

XmlReader::XmlReader(std::string_view text, std::string source, std::string_view kind)
    : source_(std::move(source)) {
    const auto refuse = [&](const std::string& what) {
        throw std::runtime_error(fmt::format("{}: {}", source_, what));
    };
    if (text.find_first_not_of(blanks) == std::string_view::npos)
        refuse(fmt::format("it is empty; a {} file has one element, <robot>", kind));
    if (text.find('\0') != std::string_view::npos)
        refuse(fmt::format("it holds a zero byte: no {} file, which is text", kind));
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        throw std::runtime_error(fmt::format("{}:{}: it is no well-formed XML: {}", source_,
                                             document_.ErrorLineNum(), parse_error(document_)));
    robot_ = document_.RootElement();
    if (!robot_)
        refuse(fmt::format("it has no element; a {} file has one, <robot>", kind));
    if (std::string_view(robot_->Name()) != "robot")
        fail(*robot_,
             fmt::format("the root element is <{}>; a {} file has <robot>", robot_->Name(), kind));
    // tinyxml2 reads on, as far as it gets.
    for (const auto* node = document_.FirstChild(); node; node = node->NextSibling())
        if (node != robot_ && (node->ToElement() || node->ToText()))
            throw std::runtime_error(fmt::format("{}:{}: a {} file has one element, <robot>, and "
                                                 "nothing but comments beside it",
                                                 source_, node->GetLineNum(), kind));
    for_each_child(*robot_, nullptr, [&](const Element& e) {
        if (std::string_view(e.Name()).starts_with("xacro:"))
            fail(e, fmt::format("<{}> is xacro, from which {} files are made; expand it first: "
                                "xacro {} > robot.{}",
                                e.Name(), kind, source_, kind == "URDF" ? "urdf" : "srdf"));
    });
}

std::string XmlReader::place(const Element& at) const {
    return fmt::format("{}:{}", source_, at.GetLineNum());
}

void XmlReader::fail(const Element& at, const std::string& what) const {
    throw std::runtime_error(fmt::format("{}: {}", place(at), what));
}

std::string XmlReader::text(const Element& of, const char* attribute) const {
    const char* found = of.Attribute(attribute);
    if (!found || std::string_view(found).find_first_not_of(blanks) == std::string_view::npos)
        fail(of, fmt::format("<{}> needs an attribute {}", of.Name(), attribute));
    return found;
}

const Element& XmlReader::child(const Element& of, const char* name) const {
    const Element* found = of.FirstChildElement(name);
    if (!found)
        fail(of, fmt::format("<{}> needs an element <{}> in it", of.Name(), name));
    return *found;
}

double XmlReader::number(const Element& of, const char* attribute) const {
    const std::string held = text(of, attribute);
    std::string_view rest = held;
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    double number = 0;
    std::string wrong = take_number(rest, number);
    if (wrong.empty() && !rest.empty())
        wrong = fmt::format("'{}' is more than one number", held);
    if (!wrong.empty())
        fail(of, fmt::format("<{} {}=...>: {}; one finite number is wanted", of.Name(), attribute,
                             wrong));
    return number;
}

double XmlReader::number(const Element& of, const char* attribute, double fallback) const {
    return of.Attribute(attribute) ? number(of, attribute) : fallback;
}

Vec3<double> XmlReader::vector(const Element& of, const char* attribute) const {
    const std::string held = text(of, attribute);
    std::string_view rest = held;
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    Vec3<double> vector;
    std::string wrong;
    int n = 0;
    for (; wrong.empty() && n < 3 && !rest.empty(); ++n)
        wrong = take_number(rest, vector[n]);
    if (wrong.empty() && (n != 3 || !rest.empty()))
        wrong = fmt::format("'{}' is not three numbers", held);
    if (!wrong.empty())
        fail(of, fmt::format("<{} {}=...>: {}; three finite numbers between blanks are wanted",
                             of.Name(), attribute, wrong));
    return vector;
}

Vec3<double> XmlReader::vector(const Element& of, const char* attribute,
                               Vec3<double> fallback) const {
    return of.Attribute(attribute) ? vector(of, attribute) : fallback;
}

std::size_t XmlReader::index(const Element& of, const char* attribute, std::string_view what,
                             std::span<const std::string_view> known) const {
    const std::string name = text(of, attribute);
    const auto found = std::ranges::find(known, name);
    if (found == known.end())
        fail(of,
             fmt::format("<{} {}=...>: {}", of.Name(), attribute, unknown_name(what, name, known)));
    return static_cast<std::size_t>(found - known.begin());
}

} // namespace boxwood
