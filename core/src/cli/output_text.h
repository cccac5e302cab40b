#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace skinglow::cli {

/// A number for people: six significant digits.
std::string short_number(double value);

/// Rows of text in columns: the first two ranged left, the others right. All rows have as many cells as the
/// first. Control characters, such as a name may hold, become question marks.
void print_table(std::ostream& out, std::vector<std::vector<std::string>> rows);

/// A path as a word of a shell's command: as it is, or in single quotes.
std::string shell_word(const std::string& path);

/// Tells on standard error what people should know about a file: "skinglow: file PATH: note: NOTE".
void tell(const std::string& path, const std::string& note);

nlohmann::ordered_json to_json(const glm::dvec3& value);
void print_json(const nlohmann::ordered_json& value);

}  // namespace skinglow::cli
