// Writes the persons of a table (tests/support/persons.csv) as closed surfaces, FOLDER/NAME.obj:
//   measured_persons TABLE FOLDER [NAME...]
#include <algorithm>
#include <exception>
#include <fstream>
#include <iostream>

#include "tests/support/measured_person.h"
#include "tests/support/obj_text.h"

int main(int argc, char** argv) try {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() < 2) throw std::runtime_error("give a table, a folder and, if not all, names");
  std::ifstream table(arguments[0]);
  for (const mssim::PersonMeasures& person : mssim::read_persons(table)) {
    if (arguments.size() > 2 && std::ranges::find(arguments, person.name) == arguments.end()) continue;
    std::ofstream(arguments[1] + "/" + person.name + ".obj")
        << mssim::obj_text(mssim::measured_person(person));
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << "measured_persons: " << error.what() << '\n';
  return 2;
}
