// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <coracle/base/columns.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace coracle
{
/// Numbers of one kind, in rows: what an archive consists of.
struct Block
{
  enum class Type
  {
    real,
    natural,
    natural_32,
    integer_32,
    byte
  };
  Type        type      = Type::byte;
  std::size_t n_rows    = 0;
  std::size_t n_columns = 1;
};

/// Some rows and columns of a block.
struct Slice
{
  std::size_t first_row, n_rows, first_column, n_columns;
};

/// Where the blocks of an archive go to and come from: a file, or memory.
class ArchiveStore
{
public:
  virtual ~ArchiveStore() = default;

  /// Of this rank.
  virtual void put(const std::string &name, const Block &block, const void *values) = 0;

  /// Of any of the ranks that saved; throws RunFailure if there is no such block.
  virtual std::vector<char>
  get(const unsigned int part, const std::string &name, Block &block) const = 0;

  /// The same of some of its values only; `block` is all of it, and a slice that is not inside is a
  /// RunFailure.
  virtual std::vector<char> get_slice(const unsigned int part,
                                      const std::string &name,
                                      const Slice       &slice,
                                      Block             &block) const = 0;

  virtual bool has(const unsigned int part, const std::string &name) const = 0;

  /// Ranks that saved.
  virtual unsigned int n_parts() const = 0;
};

/**
 * The state of a run as named blocks. A class lists its members once, in
 * `void serialize(Archive &)`, for both directions; the calls say what becomes
 * of a member when other ranks, fewer or more, go on with it:
 *
 *   same      all ranks have the same
 *   share     each rank has a share of a sum: the sum goes to rank 0
 *   largest, smallest   each rank has its own, of which the largest or smallest counts
 *   own       means nothing on other ranks: it is left as it is
 *   in_order  one list through all ranks: it is cut anew
 *   rows      particles: each part's go to one rank, who hands them on
 *   keyed     nodes and elements: found again by their keys; each rank reads all keys, but of the
 *             rows those around its own, in pieces
 *
 * As many ranks as have saved get each its own back, bit by bit. Nothing here
 * communicates.
 */
class Archive
{
public:
  enum class Mode
  {
    save,
    load
  };

  Archive(ArchiveStore &store, const Mode mode, const unsigned int rank, const unsigned int n_ranks)
    : store(store), mode(mode), rank(rank), n_ranks(n_ranks)
  {}

  bool loads() const { return mode == Mode::load; }
  /// Does each rank save, or load what it saved itself?
  bool is_exact() const { return !loads() || store.n_parts() == n_ranks; }

  /// Is there something to load by this name? True on saving.
  bool has(const std::string &name) const
  {
    return !loads() || store.has(is_exact() ? rank : 0, path + name);
  }

  /// While it lives, names are those of a part of the state.
  class Section
  {
  public:
    Section(Archive &archive, const std::string &name)
      : archive(archive), length(archive.path.size())
    {
      archive.path += name + "/";
    }
    ~Section() { archive.path.resize(length); }
    Section(const Section &) = delete;

  private:
    Archive          &archive;
    const std::size_t length;
  };

  template <typename T>
  void same(const std::string &name, T &value)
  {
    if (!loads())
      save(name, value);
    else
      load(is_exact() ? rank : 0, name, value);
  }

  template <typename T>
  void share(const std::string &name, T &value)
  {
    if (is_exact())
      return same(name, value);
    load(0, name, value);
    for (unsigned int part = 1; part < store.n_parts(); ++part)
      {
        T other = value;
        load(part, name, other);
        if constexpr (IsVector<T>::value)
          if (other.size() != value.size())
            throw_not_of_a_piece(name);
        add(other, value);
      }
    if (rank > 0)
      set_zero(value);
  }

  template <typename T>
  void largest(const std::string &name, T &value)
  {
    if (is_exact())
      return same(name, value);
    load(0, name, value);
    for (unsigned int part = 1; part < store.n_parts(); ++part)
      {
        T other{};
        load(part, name, other);
        value = std::max(value, other);
      }
  }

  template <typename T>
  void smallest(const std::string &name, T &value)
  {
    T negative = -value;
    largest(name, negative);
    value = -negative;
  }

  template <typename T>
  void own(const std::string &name, T &value)
  {
    if (is_exact())
      same(name, value);
  }

  /// All parts' entries one after the other, on every rank.
  template <typename T>
  void all(const std::string &name, std::vector<T> &values)
  {
    if (is_exact())
      return same(name, values);
    values.clear();
    for (unsigned int part = 0; part < store.n_parts(); ++part)
      {
        std::vector<T> some;
        load(part, name, some);
        values.insert(values.end(), some.begin(), some.end());
      }
  }

  /// Entries, n_together of which belong together, in the order of the ranks: other ranks get even
  /// shares of them in the same order, and read no more.
  template <typename T>
  void in_order(const std::string &name, std::vector<T> &values, const unsigned int n_together = 1)
  {
    if (is_exact())
      return same(name, values);
    std::vector<std::size_t> ends;
    for (unsigned int part = 0; part < store.n_parts(); ++part)
      ends.push_back((part > 0 ? ends.back() : 0) + look(part, name, describe<T>(0)).n_rows);
    if (ends.back() % n_together != 0)
      throw_not_of_a_piece(name);
    const std::size_t n     = ends.back() / n_together;
    const std::size_t begin = n * rank / n_ranks * n_together,
                      end   = n * (rank + 1) / n_ranks * n_together;
    values.resize(end - begin);
    for (unsigned int part = 0; part < store.n_parts(); ++part)
      {
        const std::size_t before = (part > 0 ? ends[part - 1] : 0), first = std::max(begin, before),
                          last = std::min(end, ends[part]);
        if (first >= last)
          continue;
        const auto bytes = get_slice(part, name, {first - before, last - first, 0, 1});
        std::copy(bytes.begin(),
                  bytes.end(),
                  reinterpret_cast<char *>(values.data() + (first - begin)));
      }
  }

  void rows(const std::string &name, Columns &columns);

  /// Columns that hold sums over the copies of a row: a row's owner gets all of it.
  struct Summed
  {
    unsigned int first = 0, n = 0;
  };

  /**
   * @param keys    of this rank's rows, owned ones first
   * @param columns as many rows as keys, or more, which only the ranks that saved get back
   */
  void keyed(const std::string                &name,
             const std::vector<std::uint64_t> &keys,
             const unsigned int                n_owned,
             Columns                          &columns,
             const Summed                     &summed);

private:
  template <typename T>
  struct IsVector : std::false_type
  {};
  template <typename T>
  struct IsVector<std::vector<T>> : std::true_type
  {};
  template <typename T>
  struct IsTensor : std::false_type
  {};
  template <int rank, int dim>
  struct IsTensor<dealii::Tensor<rank, dim>> : std::true_type
  {};
  template <int dim>
  struct IsTensor<dealii::Point<dim>> : std::true_type
  {};

  /// Of values that may be copied as bytes. deal.II's tensors may, whatever the compiler thinks.
  template <typename T>
  static Block describe(const std::size_t n_rows)
  {
    static_assert(std::is_trivially_copyable_v<T> || IsTensor<T>::value ||
                    std::is_standard_layout_v<T>,
                  "values are stored as bytes");
    if constexpr (std::is_same_v<T, double> || IsTensor<T>::value)
      return {Block::Type::real, n_rows, sizeof(T) / sizeof(double)};
    else if constexpr (std::is_integral_v<T> && std::is_unsigned_v<T> && sizeof(T) == 8)
      return {Block::Type::natural, n_rows, 1};
    else if constexpr (std::is_integral_v<T> && std::is_unsigned_v<T> && sizeof(T) == 4)
      return {Block::Type::natural_32, n_rows, 1};
    else if constexpr (std::is_same_v<T, int>)
      return {Block::Type::integer_32, n_rows, 1};
    else
      return {Block::Type::byte, n_rows, sizeof(T)};
  }

  template <typename T>
  void save(const std::string &name, const T &value)
  {
    if constexpr (IsVector<T>::value)
      {
        using Entry = typename T::value_type;
        if constexpr (IsVector<Entry>::value || std::is_same_v<Entry, std::string>)
          {
            std::vector<std::uint64_t>                                          sizes;
            std::vector<std::decay_t<decltype(*std::declval<Entry>().begin())>> entries;
            for (const Entry &entry : value)
              {
                sizes.push_back(entry.size());
                entries.insert(entries.end(), entry.begin(), entry.end());
              }
            save(name + ".sizes", sizes);
            save(name, entries);
          }
        else
          put(name, describe<Entry>(value.size()), value.data());
      }
    else
      put(name, describe<T>(1), &value);
  }

  template <typename T>
  void load(const unsigned int part, const std::string &name, T &value) const
  {
    if constexpr (IsVector<T>::value)
      {
        using Entry = typename T::value_type;
        if constexpr (IsVector<Entry>::value || std::is_same_v<Entry, std::string>)
          {
            std::vector<std::uint64_t>                                          sizes;
            std::vector<std::decay_t<decltype(*std::declval<Entry>().begin())>> entries;
            load(part, name + ".sizes", sizes);
            load(part, name, entries);
            value.clear();
            auto first = entries.begin();
            for (const std::uint64_t size : sizes)
              {
                if (size > static_cast<std::uint64_t>(entries.end() - first))
                  throw_not_of_a_piece(name);
                value.emplace_back(first, first + size);
                first += size;
              }
            if (first != entries.end())
              throw_not_of_a_piece(name);
          }
        else
          {
            const std::vector<char> bytes = get(part, name, describe<Entry>(0));
            value.resize(bytes.size() / sizeof(Entry));
            std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char *>(value.data()));
          }
      }
    else
      {
        const std::vector<char> bytes = get(part, name, describe<T>(1));
        std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char *>(&value));
      }
  }

  template <typename T>
  static void add(const T &other, T &value)
  {
    if constexpr (IsVector<T>::value)
      for (std::size_t i = 0; i < value.size(); ++i)
        value[i] += other[i];
    else
      value += other;
  }

  template <typename T>
  static void set_zero(T &value)
  {
    if constexpr (IsVector<T>::value)
      std::fill(value.begin(), value.end(), typename T::value_type());
    else
      value = T();
  }

  /// The RunFailure of blocks that do not fit each other.
  [[noreturn]] void throw_not_of_a_piece(const std::string &name) const;

  void put(const std::string &name, const Block &block, const void *values);
  /// Checks that the block is of the type and width, and has as many rows if that is not 0.
  std::vector<char> get(const unsigned int part, const std::string &name, const Block &block) const;

  /// What there is, checked like that.
  Block look(const unsigned int part, const std::string &name, const Block &block) const;
  std::vector<char>
  get_slice(const unsigned int part, const std::string &name, const Slice &slice) const;

  void save_columns(const std::string &name, Columns &columns);
  /// Appends the rows of one part.
  void load_columns(const unsigned int part, const std::string &name, Columns &columns) const;
  void load_by_key(const std::string                &name,
                   const std::vector<std::uint64_t> &keys,
                   const unsigned int                n_owned,
                   Columns                          &columns,
                   const Summed                     &summed) const;

  /// Rows by key are read in pieces of at most so many bytes.
  static constexpr std::size_t bytes_at_once = std::size_t(1) << 22;

  ArchiveStore      &store;
  const Mode         mode;
  const unsigned int rank, n_ranks;
  std::string        path;
};
} // namespace coracle
