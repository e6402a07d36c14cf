// Times CGAL on the inputs of `bounds_timing`, which writes them as raw doubles.
// Usage: bounds_cgal hull|dual|constructed FILE N REPEATS
//   hull: N points (3 doubles); dual, constructed: interior point, then N planes (normal, offset; 4 doubles).
// Prints thread time of the fastest repeat in ms, and the corners (hull) or faces (half-spaces).
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#include <CGAL/Convex_hull_3/dual/halfspace_intersection_3.h>
#include <CGAL/Convex_hull_3/dual/halfspace_intersection_with_constructions_3.h>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Plane = Kernel::Plane_3;
using Mesh = CGAL::Surface_mesh<Point>;

static double now_ms() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return t.tv_sec * 1e3 + t.tv_nsec * 1e-6;
}

int main(int argc, char** argv) {
    if (argc != 5) return 2;
    const std::string what = argv[1];
    const long n = std::atol(argv[3]);
    const int repeats = std::atoi(argv[4]);
    std::vector<double> data(what == "hull" ? 3 * n : 3 + 4 * n);
    FILE* file = std::fopen(argv[2], "rb");
    if (!file || std::fread(data.data(), 8, data.size(), file) != data.size()) return 3;
    std::fclose(file);
    std::vector<Point> points;
    std::vector<Plane> planes;
    const Point inside(data[0], data[1], data[2]);
    for (long i = 0; i < n; ++i) {
        const double* d = what == "hull" ? &data[3 * i] : &data[3 + 4 * i];
        if (what == "hull") points.emplace_back(d[0], d[1], d[2]);
        else planes.emplace_back(d[0], d[1], d[2], d[3]);
    }
    double best = 1e300;
    std::size_t count = 0;
    for (int r = 0; r < repeats; ++r) {
        Mesh mesh;
        const double start = now_ms();
        if (what == "hull") CGAL::convex_hull_3(points.begin(), points.end(), mesh);
        else if (what == "dual") CGAL::halfspace_intersection_3(planes.begin(), planes.end(), mesh, inside);
        else CGAL::halfspace_intersection_with_constructions_3(planes.begin(), planes.end(), mesh, inside);
        best = std::min(best, now_ms() - start);
        count = what == "hull" ? mesh.number_of_vertices() : mesh.number_of_faces();
    }
    std::printf("%.6f %zu\n", best, count);
}
