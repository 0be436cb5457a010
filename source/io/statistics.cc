// SPDX-License-Identifier: GPL-3.0-or-later
#include <deal.II/base/exceptions.h>

#include <coracle/io/disk.h>
#include <coracle/io/statistics.h>
#include <coracle/io/text.h>

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
  AssertThrow(!header_written && !row_open,
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
  if (!header_written)
    {
      std::string header;
      for (unsigned int c = 0; c < column_titles.size(); ++c)
        header += (c > 0 ? "," : "") + csv_text(column_titles[c]);
      write_line(header);
      header_written = true;
    }
  write_line(line);
  row_open = false;
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
