// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/exceptions.h>

#include <coracle/base/exceptions.h>
#include <coracle/io/disk.h>
#include <coracle/io/statistics.h>
#include <coracle/io/text.h>

#include <filesystem>

namespace coracle
{
namespace
{
/// A name of the user's may hold a comma or a quote: then the title is quoted as in RFC 4180.
std::string
csv_text(const std::string &text)
{
  if (text.find_first_of(",\"\n") == std::string::npos)
    return text;
  std::string result = "\"";
  for (const char c : text)
    result += (c == '"' ? std::string("\"\"") : std::string(1, c));
  return result + "\"";
}
} // namespace

Statistics::Statistics(const std::string &file_name, MPI_Comm communicator)
  : file_name(file_name), writes(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
{}

void
Statistics::add_column(const std::string &name, const std::string &unit)
{
  AssertThrow(n_rows == 0 && !row_open,
              dealii::ExcMessage("Column '" + name + "' came after the first row."));
  AssertThrow(column_of_name.emplace(name, column_titles.size()).second,
              dealii::ExcMessage("There are two statistics columns '" + name + "'."));
  column_titles.push_back(unit.empty() ? name : name + " [" + unit + "]");
}

void
Statistics::add_vector(const std::string &name, const std::string &unit, const unsigned int dim)
{
  for (unsigned int d = 0; d < dim; ++d)
    add_column(name + std::string(".") + "xyz"[d], unit);
}

void
Statistics::begin_row()
{
  AssertThrow(!row_open, dealii::ExcMessage("The last statistics row was not ended."));
  row_open = true;
  values.assign(column_titles.size(), 0.);
  is_set.assign(column_titles.size(), false);
}

void
Statistics::set(const std::string &name, const double value)
{
  const auto column = column_of_name.find(name);
  AssertThrow(row_open && column != column_of_name.end(),
              dealii::ExcMessage("There is no statistics column '" + name + "', or no row."));
  AssertThrow(!is_set[column->second],
              dealii::ExcMessage("Statistics column '" + name + "' was set twice."));
  values[column->second] = value;
  is_set[column->second] = true;
}

void
Statistics::end_row()
{
  AssertThrow(row_open, dealii::ExcMessage("There is no statistics row to end."));
  std::string line;
  for (unsigned int c = 0; c < values.size(); ++c)
    {
      AssertThrow(is_set[c],
                  dealii::ExcMessage("Statistics column '" + column_titles[c] + "' was not set."));
      line += (c > 0 ? "," : "") + exact_number(values[c]);
    }
  if (n_rows == 0)
    write_line(header());
  write_line(line);
  ++n_rows;
  row_open = false;
}

std::string
Statistics::header() const
{
  std::string line;
  for (unsigned int c = 0; c < column_titles.size(); ++c)
    line += (c > 0 ? "," : "") + csv_text(column_titles[c]);
  return line;
}

void
Statistics::serialize(Archive &archive)
{
  archive.same("statistics.n_rows", n_rows);
  if (!archive.loads() && file.is_open())
    make_durable(file_name);
  if (archive.loads() && writes && n_rows > 0)
    go_on();
}

void
Statistics::go_on()
{
  std::ifstream  old(file_name);
  std::string    line;
  std::uint64_t  n            = 0;
  std::streamoff end          = 0;
  const bool     same_columns = std::getline(old, line) && line == header();
  for (; same_columns && n < n_rows && std::getline(old, line) && !old.eof(); ++n)
    end = old.tellg();
  if (n < n_rows)
    throw RunFailure("results of the run that is to be continued are missing",
                     file_name + (same_columns ? ": " + std::to_string(n) + " rows instead of " +
                                                   std::to_string(n_rows)
                                               : ": it does not exist, or has other columns"),
                     "put the file back, or run the case from its start, without --restart");
  old.close();
  std::error_code error;
  std::filesystem::resize_file(file_name, end, error);
  if (error)
    throw_not_written(file_name + ": " + error.message());
  file.open(file_name, std::ios::app);
}

void
Statistics::write_line(const std::string &line)
{
  if (!writes)
    return;
  if (!file.is_open())
    file.open(file_name);
  file << line << std::endl;
  if (!file)
    throw_not_written(file_name);
}
} // namespace coracle
