// What the library offers: the declaration.  库的接口声明。
#pragma once

#include <learning_topic/Person.h>

#include <string>

namespace learning_library {

// The person in words: "Tom, 18, male".  用文字描述一个人
std::string describe(const learning_topic::Person& person);

}  // namespace learning_library
