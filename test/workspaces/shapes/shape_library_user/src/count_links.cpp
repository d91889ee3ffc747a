#include <shape_library/links.h>
#include <cstdio>

int main() {
  std::printf("%d\n", links_in("<robot name='r'><link name='base'/></robot>"));
  return 0;
}
