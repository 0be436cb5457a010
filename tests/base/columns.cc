// SPDX-License-Identifier: GPL-3.0-or-later
// Columns keep their rows through growth, reordering and copying, end with a whole spare pack of
// zeros, and never move memory that has room.
#include <coracle/base/columns.h>

#include "tests.h"

#include <vector>

using namespace coracle;

int
main()
{
  initlog();
  Columns columns(3);
  columns.resize(5);
  for (unsigned int i = 0; i < 5; ++i)
    for (unsigned int c = 0; c < 3; ++c)
      columns[c][i] = 10. * c + i;

  columns.resize(1000);
  deallog << "rows: " << columns.size() << ", columns: " << columns.n_columns() << std::endl;
  deallog << "old row kept: " << columns[0][4] << ' ' << columns[1][4] << ' ' << columns[2][4]
          << ", new row zero: " << (columns[2][5] == 0) << std::endl;
  deallog << "last pack readable: " << (load<Pack8>(columns[1] + 999)[0] == 0) << std::endl;

  columns.resize(5);
  columns.reorder(std::vector<unsigned int>{4, 2, 0});
  for (unsigned int i = 0; i < 3; ++i)
    deallog << "row " << i << ": " << columns[0][i] << ' ' << columns[1][i] << ' ' << columns[2][i]
            << std::endl;

  deallog << "spare entries are zero: " << (columns[0][3] == 0 && columns[2][4] == 0) << std::endl;

  double row[3];
  columns.get_row(1, row);
  columns.set_row(2, row);
  deallog << "copied: " << columns[0][2] << ' ' << columns[1][2] << ' ' << columns[2][2]
          << std::endl;

  columns.resize(2);
  columns.resize(4);
  deallog << "rows that come back are zero: " << (columns[0][2] == 0 && columns[2][3] == 0)
          << std::endl;
  deallog << "memory counted: " << (columns.memory_consumption() >= 3 * 4 * sizeof(double))
          << std::endl;
}
