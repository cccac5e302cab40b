// Built by the test `installed_package` against the installed skinglow::core alone.
#include <skinglow/box.h>

int main() {
    const skinglow::Box box{{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
    return box.radius() == 1.0 ? 0 : 1;
}
