#include "io/describe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "io/nearest.h"

namespace trackbed {
namespace {

/// A default as it would stand in the file.
std::string to_text(const Value& value, Dimension dimension) {
  const auto number = [&](double v) {
    const std::string text = to_text(v, dimension);
    return dimension == Dimension::none ? text : '"' + text + '"';
  };
  const auto list = [](const auto& values, const auto& convert) {
    std::vector<std::string> texts;
    for (const auto& entry : values) texts.push_back(convert(entry));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  };
  const auto quoted = [](const auto& v) { return fmt::format("\"{}\"", std::filesystem::path(v).string()); };
  const auto convert = [&](const auto& v) -> std::string {
    using T = std::decay_t<decltype(v)>;
    if constexpr (std::is_same_v<T, double>)
      return number(v);
    else if constexpr (std::is_same_v<T, Vec3> || std::is_same_v<T, std::vector<double>>)
      return list(v, number);
    else if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, std::filesystem::path>)
      return quoted(v);
    else if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::int64_t>)
      return fmt::format("{}", v);
    else
      return list(v, quoted);
  };
  return std::visit(convert, value);
}

/// Writes the rows of one page; kinds that it meets become pages of the description.
class Describer : public Fields {
 public:
  Describer(Description& all, Page& page, std::string prefix)
      : all_(all), page_(page), prefix_(std::move(prefix)) {}
  void check(bool, std::string_view, std::string_view, std::string_view) override {}

 protected:
  void visit_result(std::string_view name, Dimension dimension, std::string_view meaning, bool) override {
    page_.results.push_back({std::string(name), std::string(si_unit_of(dimension)), std::string(meaning)});
  }

  std::optional<Value> visit(const Field& field, const std::optional<Value>& current) override {
    std::string fallback = current ? to_text(*current, field.dimension) : "-";
    if (field.key.required) fallback = "required";
    page_.rows.push_back({prefix_ + field.key.name, type_of(field), std::move(fallback),
                          trackbed::to_text(field.range, field.dimension), field.meaning});
    return std::nullopt;
  }

  void visit(const Field& field, Elements& elements) override {
    const std::optional<KindNames> kinds = elements.kinds();
    std::string type = type_of(field);
    if (kinds) type += fmt::format("; {}: a {}, see there", kinds->selector, kinds->family);
    page_.rows.push_back(
        {prefix_ + field.key.name, std::move(type), fallback_of(field, elements), "", field.meaning});
    if (kinds) {
      describe_kinds(*kinds, elements);
      return;
    }
    constexpr std::string_view element = "NAME";
    std::string inside = prefix_ + field.key.name + ".";
    if (field.type == FieldType::table) inside += fmt::format("{}.", element);
    if (field.type == FieldType::sequence) inside.insert(inside.size() - 1, "[]");
    Describer describer(all_, page_, inside);
    if (elements.size() > 0)
      elements.visit(0, describer);
    else
      elements.append(std::string(element), {}, describer);
  }

 private:
  static std::string fallback_of(const Field& field, const Elements& elements) {
    if (field.key.required) return "required";
    if (elements.size() == 0) return "-";
    if (elements.kinds() && field.type == FieldType::section) return elements.kind(0);
    return "";  // the defaults of its keys
  }

  void describe_kinds(const KindNames& kinds, Elements& elements) {
    const auto known = [&](const auto& family) { return family.first == kinds.family; };
    if (std::any_of(all_.families.begin(), all_.families.end(), known))
      return;  // a list of stages in a stage
    const std::size_t family = all_.families.size();
    all_.families.emplace_back(kinds.family, std::vector<Page>());
    for (std::size_t i = 0; i < kinds.names.size(); ++i) {
      Page page{kinds.names[i], kinds.meanings[i], {}};
      Describer describer(all_, page, {});
      elements.clear();
      elements.append("NAME", kinds.names[i], describer);
      all_.families[family].second.push_back(std::move(page));
    }
  }

  Description& all_;
  Page& page_;
  std::string prefix_;
};

std::string markdown_cell(std::string_view text) {
  std::string cell;
  for (char c : text) {
    if (c == '|') cell += '\\';
    cell += c;
  }
  return cell;
}

std::string markdown_table(const Page& page) {
  if (page.rows.empty()) return "It has no keys.\n";
  std::string text = "| key | value | default | range | meaning |\n|---|---|---|---|---|\n";
  for (const Page::Row& row : page.rows) {
    const bool shows_value = !row.fallback.empty() && row.fallback != "-" && row.fallback != "required";
    const std::string fallback = shows_value ? '`' + row.fallback + '`' : row.fallback;
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.key, markdown_cell(row.type),
                        markdown_cell(fallback), markdown_cell(row.range), markdown_cell(row.meaning));
  }
  return text;
}

/// Nothing for a page that leaves none.
std::string markdown_results(const Page& page) {
  if (page.results.empty()) return {};
  std::string text = "\n| result | unit | meaning |\n|---|---|---|\n";
  for (const Page::Result& r : page.results)
    text += fmt::format("| `{}` | {} | {} |\n", r.name, r.unit, markdown_cell(r.meaning));
  return text;
}

}  // namespace

Description describe_with(std::string name, std::string meaning,
                          const std::function<void(Fields&)>& declare_all) {
  Description description;
  description.top = {std::move(name), std::move(meaning), {}};
  Describer describer(description, description.top, {});
  declare_all(describer);
  return description;
}

Page Description::find(std::string_view name) const {
  std::vector<std::string> known;
  for (const auto& [family, pages] : families) {
    for (const Page& page : pages) {
      if (page.name == name) return page;
      known.push_back(page.name);
    }
  }
  Page part{std::string(name), {}, {}};
  for (const Page::Row& row : top.rows) {
    const std::string_view head = std::string_view(row.key).substr(0, row.key.find_first_of(".["));
    if (row.key == head) known.emplace_back(head);
    if (head == name) part.rows.push_back(row);
  }
  if (!part.rows.empty()) return part;
  throw InputError(
      fmt::format("there is nothing called {} to describe\n  hint: {}", name, known_words(name, known)));
}

std::string to_text(const Page& page) {
  std::string text = page.name;
  if (!page.meaning.empty()) text += ": " + page.meaning;
  text += '\n';
  std::size_t key_width = 0;
  for (const Page::Row& row : page.rows) key_width = std::max(key_width, row.key.size());
  for (const Page::Row& row : page.rows) {
    std::vector<std::string> facts = {row.type};
    if (!row.range.empty()) facts.push_back(row.range);
    if (row.fallback == "required")
      facts.push_back("required");
    else if (row.fallback == "-")
      facts.push_back("may be absent");
    else if (!row.fallback.empty())
      facts.push_back("default " + row.fallback);
    text += fmt::format("  {:{}}  {}\n", row.key, key_width, fmt::join(facts, "; "));
    text += fmt::format("  {:{}}  {}\n", "", key_width, row.meaning);
  }
  if (page.results.empty()) return text;
  text += "results:\n";
  std::size_t name_width = 0;
  for (const Page::Result& r : page.results) name_width = std::max(name_width, r.name.size());
  for (const Page::Result& r : page.results)
    text += fmt::format("  {:{}}  [{}]  {}\n", r.name, name_width, r.unit, r.meaning);
  return text;
}

std::string to_text(const Description& description) {
  std::string text = to_text(description.top);
  for (const auto& [family, pages] : description.families) {
    text += fmt::format("\nevery {}:\n", family);
    std::size_t width = 0;
    for (const Page& page : pages) width = std::max(width, page.name.size());
    for (const Page& page : pages) text += fmt::format("  {:{}}  {}\n", page.name, width, page.meaning);
  }
  return text;
}

std::string to_markdown(const Description& description) {
  std::string text = fmt::format("# {}\n\n{}\n\n", description.top.name, description.top.meaning);
  text += "Made from the declarations in the source, as `trackbed describe` is; do not edit.\n\n";
  text += markdown_table(description.top);
  for (const auto& [family, pages] : description.families) {
    text += fmt::format("\n## Every {}\n", family);
    for (const Page& page : pages)
      text += fmt::format("\n### {}\n\n{}\n\n{}{}", page.name, page.meaning, markdown_table(page),
                          markdown_results(page));
  }
  return text;
}

}  // namespace trackbed
