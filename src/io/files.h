// Files as wholes: read, and written so that a reader never sees half of one.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// The bytes of a file. Throws InputError when it cannot be read or is larger than `limit` [bytes].
std::string read_file(const std::filesystem::path& path, std::size_t limit = std::size_t{1} << 40);

/// Whether a file must survive the loss of power once it is written.
enum class Lasting { in_memory, on_disk };

/// Writes beside `path` and renames: `path` holds the old text or the new, never a part. Throws RunError.
void write_file(const std::filesystem::path& path, std::string_view bytes,
                Lasting lasting = Lasting::in_memory);

/// The same with several parts, one after the other: large ones need not be joined before.
void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts,
                Lasting lasting = Lasting::in_memory);

/// Makes a folder and those above it. Throws RunError.
void make_folder(const std::filesystem::path& path);

/// Files that match a pattern ("stones/*.obj", "*/a?.csv", "[ab].stl"), sorted by name; empty when none does.
std::vector<std::filesystem::path> expand_pattern(const std::filesystem::path& pattern);

/// Has the path a *, ? or [ ?
bool is_pattern(const std::filesystem::path& path);

}  // namespace trackbed
