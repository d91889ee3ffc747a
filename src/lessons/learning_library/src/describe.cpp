// The library's implementation.  库的实现。
#include <learning_library/describe.h>

namespace learning_library {

std::string describe(const learning_topic::Person& person) {
  const char* sex = person.sex == learning_topic::Person::male     ? "male"
                    : person.sex == learning_topic::Person::female ? "female"
                                                                   : "unknown";
  return person.name + ", " + std::to_string(person.age) + ", " + sex;
}

}  // namespace learning_library
