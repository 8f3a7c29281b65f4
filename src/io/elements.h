// The tables inside a table, seen without their types. Part of io/schema.h, which includes it.
#pragma once

#include "io/schema.h"

namespace trackbed {

/// How one element is made and declared: plain structs by their own `declare` ...
template <class T>
struct PlainRow {
  T make(const std::string&) const { return T{}; }
  void visit(T& value, Fields& f) const { declare(f, value); }
  std::string kind(const T&) const { return {}; }
  std::optional<KindNames> kinds() const { return std::nullopt; }
};

/// ... and the others by the row of their registry.
template <class Base>
struct KindRow {
  const Kinds<Base>* registry;

  OneOf<Base> make(const std::string& kind) const { return {kind, registry->find(kind)->make()}; }
  void visit(OneOf<Base>& value, Fields& f) const {
    registry->find(value.kind)->declare_input(f, *value.input);
  }
  std::string kind(const OneOf<Base>& value) const { return value.kind; }
  std::optional<KindNames> kinds() const {
    KindNames all{registry->family, registry->selector, {}, {}};
    for (const Kind<Base>& row : registry->rows) {
      all.names.push_back(row.name);
      all.meanings.push_back(row.meaning);
    }
    return all;
  }
};

template <class T, class Row>
class SequenceElements : public Elements {
 public:
  SequenceElements(std::vector<T>& values, Row row) : values_(values), row_(row) {}
  std::size_t size() const override { return values_.size(); }
  std::string name(std::size_t) const override { return {}; }
  std::string kind(std::size_t i) const override { return row_.kind(values_[i]); }
  std::optional<KindNames> kinds() const override { return row_.kinds(); }
  void visit(std::size_t i, Fields& f) override { row_.visit(values_[i], f); }
  void clear() override { values_.clear(); }
  void append(const std::string&, const std::string& kind, Fields& f) override {
    values_.push_back(row_.make(kind));
    row_.visit(values_.back(), f);
  }

 private:
  std::vector<T>& values_;
  Row row_;
};

template <class T, class Row>
class TableElements : public Elements {
 public:
  TableElements(std::map<std::string, T>& values, Row row) : values_(values), row_(row) {}
  std::size_t size() const override { return values_.size(); }
  std::string name(std::size_t i) const override { return at(i)->first; }
  std::string kind(std::size_t i) const override { return row_.kind(at(i)->second); }
  std::optional<KindNames> kinds() const override { return row_.kinds(); }
  void visit(std::size_t i, Fields& f) override { row_.visit(at(i)->second, f); }
  void clear() override { values_.clear(); }
  void append(const std::string& name, const std::string& kind, Fields& f) override {
    row_.visit(values_.insert_or_assign(name, row_.make(kind)).first->second, f);
  }

 private:
  auto at(std::size_t i) const { return std::next(values_.begin(), static_cast<std::ptrdiff_t>(i)); }
  std::map<std::string, T>& values_;
  Row row_;
};

/// A section that is always there: its own keys have defaults or are required.
template <class T>
class SectionElements : public Elements {
 public:
  explicit SectionElements(T& value) : value_(value) {}
  std::size_t size() const override { return 1; }
  std::string name(std::size_t) const override { return {}; }
  std::string kind(std::size_t) const override { return {}; }
  std::optional<KindNames> kinds() const override { return std::nullopt; }
  void visit(std::size_t, Fields& f) override { declare(f, value_); }
  void clear() override {}  // the defaults of its keys stand
  void append(const std::string&, const std::string&, Fields& f) override { declare(f, value_); }

 private:
  T& value_;
};

/// A section that may be absent.
template <class T>
class SectionElements<std::optional<T>> : public Elements {
 public:
  explicit SectionElements(std::optional<T>& value) : value_(value) {}
  std::size_t size() const override { return value_ ? 1 : 0; }
  std::string name(std::size_t) const override { return {}; }
  std::string kind(std::size_t) const override { return {}; }
  std::optional<KindNames> kinds() const override { return std::nullopt; }
  void visit(std::size_t, Fields& f) override { declare(f, *value_); }
  void clear() override { value_.reset(); }
  void append(const std::string&, const std::string&, Fields& f) override { declare(f, value_.emplace()); }

 private:
  std::optional<T>& value_;
};

template <class Base>
class SectionElements<OneOf<Base>> : public Elements {
 public:
  SectionElements(OneOf<Base>& value, KindRow<Base> row) : value_(value), row_(row) {}
  std::size_t size() const override { return value_.input ? 1 : 0; }
  std::string name(std::size_t) const override { return {}; }
  std::string kind(std::size_t) const override { return value_.kind; }
  std::optional<KindNames> kinds() const override { return row_.kinds(); }
  void visit(std::size_t, Fields& f) override { row_.visit(value_, f); }
  void clear() override { value_ = {}; }
  void append(const std::string&, const std::string& kind, Fields& f) override {
    value_ = row_.make(kind);
    row_.visit(value_, f);
  }

 private:
  OneOf<Base>& value_;
  KindRow<Base> row_;
};

template <class T>
void Fields::section(Key key, T& value, std::string_view meaning) {
  SectionElements<T> elements(value);
  visit({std::move(key), FieldType::section, std::string(meaning)}, elements);
}
template <class Base>
void Fields::section(Key key, OneOf<Base>& value, const Kinds<Base>& kinds, std::string_view meaning) {
  SectionElements<OneOf<Base>> elements(value, {&kinds});
  visit({std::move(key), FieldType::section, std::string(meaning)}, elements);
}
template <class T>
void Fields::table(Key key, std::map<std::string, T>& value, std::string_view meaning) {
  TableElements<T, PlainRow<T>> elements(value, {});
  visit({std::move(key), FieldType::table, std::string(meaning)}, elements);
}
template <class Base>
void Fields::table(Key key, std::map<std::string, OneOf<Base>>& value, const Kinds<Base>& kinds,
                   std::string_view meaning) {
  TableElements<OneOf<Base>, KindRow<Base>> elements(value, {&kinds});
  visit({std::move(key), FieldType::table, std::string(meaning)}, elements);
}
template <class T>
void Fields::sequence(Key key, std::vector<T>& value, std::string_view meaning) {
  SequenceElements<T, PlainRow<T>> elements(value, {});
  visit({std::move(key), FieldType::sequence, std::string(meaning)}, elements);
}
template <class Base>
void Fields::sequence(Key key, std::vector<OneOf<Base>>& value, const Kinds<Base>& kinds,
                      std::string_view meaning) {
  SequenceElements<OneOf<Base>, KindRow<Base>> elements(value, {&kinds});
  visit({std::move(key), FieldType::sequence, std::string(meaning)}, elements);
}

}  // namespace trackbed
