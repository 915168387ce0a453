// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

/// The names of a list of items. Items with the same name share its text: each takes four more bytes.
class NameList {
 public:
  /// An empty list.
  NameList() = default;
  ///@{
  /// One item for each name, each with its own text.
  NameList(std::initializer_list<std::string> names) : NameList(std::vector<std::string>(names)) {}
  NameList(std::vector<std::string> names) : texts_(std::move(names)) {
    for (std::uint32_t i = 0; i < texts_.size(); ++i) text_of_.push_back(i);
  }
  ///@}
  /// Thing i has the text number `text_of[i]`.
  /// Requires  every entry of `text_of` is an index into `texts`.
  NameList(std::vector<std::string> texts, std::vector<std::uint32_t> text_of)
      : texts_(std::move(texts)), text_of_(std::move(text_of)) {}

  /// The number of items, not of texts.
  std::size_t size() const { return text_of_.size(); }
  /// True if there are no items.
  bool empty() const { return text_of_.empty(); }
  /// The name of item i.
  const std::string& operator[](std::size_t i) const { return texts_[text_of_[i]]; }

  /// Adds an item with a new name.
  void push_back(std::string name) {
    text_of_.push_back(static_cast<std::uint32_t>(texts_.size()));
    texts_.push_back(std::move(name));
  }
  /// Adds an item that shares the name of item `i`.
  void share(std::size_t i) { text_of_.push_back(text_of_[i]); }

  /// The texts in the order of their first use, and the index of each item's text.
  ///@{
  const std::vector<std::string>& texts() const { return texts_; }
  const std::vector<std::uint32_t>& text_of() const { return text_of_; }
  ///@}

  /// An input iterator over the names, in the order of the items.
  class Iterator {
   public:
    ///@{
    /// A standard input iterator.
    using iterator_category = std::input_iterator_tag;
    using value_type = std::string;
    using difference_type = std::ptrdiff_t;
    using pointer = const std::string*;
    using reference = const std::string&;

    Iterator(const NameList& list, std::size_t at) : list_(&list), at_(at) {}
    reference operator*() const { return (*list_)[at_]; }
    Iterator& operator++() { return ++at_, *this; }
    Iterator operator++(int) { return {*list_, at_++}; }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }
    ///@}

   private:
    const NameList* list_;
    std::size_t at_;
  };
  ///@{
  /// The names, for range-based loops.
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }
  ///@}

  /// Whether the items have the same names, regardless of sharing.
  bool operator==(const NameList& other) const {
    if (size() != other.size()) return false;
    for (std::size_t i = 0; i < size(); ++i)
      if ((*this)[i] != other[i]) return false;
    return true;
  }

 private:
  std::vector<std::string> texts_;
  std::vector<std::uint32_t> text_of_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
