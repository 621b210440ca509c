#!/usr/bin/env python3
"""Open3D's global registrations on the trials of `arthronaut experiment registration --write-trials FOLDER`.

FPFH features with RANSAC, and fast global registration, each polished by point-to-plane ICP, without an initial
guess. Success is a target error below 2 mm, as for our own. Prints rows for the table of docs/benchmarks.md.

    apt-get install python3-open3d
    OMP_NUM_THREADS=1 /usr/bin/python3 tests/benchmarks/open3d_registration.py FOLDER...
"""
import csv
import json
import pathlib
import statistics
import sys
import time

import numpy as np
import open3d as o3d

VOXEL_MM = 1.0  # the strokes' spacing, and that of the bone's samples
SUCCESS_MM = 2.0
REGISTRATION = o3d.pipelines.registration


def prepare(cloud):
    """Features of a cloud with normals, at the radii that Open3D's documentation advises for the voxel size."""
    feature = REGISTRATION.compute_fpfh_feature(
        cloud, o3d.geometry.KDTreeSearchParamHybrid(radius=5 * VOXEL_MM, max_nn=100))
    return cloud, feature


def read_bone(folder):
    mesh = o3d.io.read_triangle_mesh(str(folder / "bone.ply"))
    mesh.compute_vertex_normals()
    count = int(mesh.get_surface_area() / VOXEL_MM**2)
    return prepare(mesh.sample_points_uniformly(count))


def read_strokes(file):
    with open(file, newline="", encoding="utf-8") as stream:
        points = [[float(row[k]) for k in ("x_mm", "y_mm", "z_mm")] for row in csv.DictReader(stream)]
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(np.array(points)))
    cloud = cloud.voxel_down_sample(VOXEL_MM)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(radius=4 * VOXEL_MM, max_nn=30))
    # The probe comes from outside; the side of the world marker, the origin, is the best guess for it.
    cloud.orient_normals_towards_camera_location(np.zeros(3))
    return prepare(cloud)


def polish(strokes, bone, bone_from_marker):
    for reach_mm in (6.0, 2.0, 1.0):
        bone_from_marker = REGISTRATION.registration_icp(
            strokes, bone, reach_mm, bone_from_marker,
            REGISTRATION.TransformationEstimationPointToPlane(),
            REGISTRATION.ICPConvergenceCriteria(max_iteration=60)).transformation
    return bone_from_marker


def by_ransac(strokes, strokes_feature, bone, bone_feature):
    reach = 1.5 * VOXEL_MM
    return REGISTRATION.registration_ransac_based_on_feature_matching(
        strokes, bone, strokes_feature, bone_feature, True, reach,
        REGISTRATION.TransformationEstimationPointToPoint(False), 3,
        [REGISTRATION.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         REGISTRATION.CorrespondenceCheckerBasedOnDistance(reach)],
        REGISTRATION.RANSACConvergenceCriteria(1_000_000, 0.999)).transformation


def by_fast_global(strokes, strokes_feature, bone, bone_feature):
    return REGISTRATION.registration_fgr_based_on_feature_matching(
        strokes, bone, strokes_feature, bone_feature,
        REGISTRATION.FastGlobalRegistrationOption(maximum_correspondence_distance=0.5 * VOXEL_MM)).transformation


def true_marker_from_bone(document):
    w, x, y, z = document["marker_from_bone"]["q_wxyz"]
    truth = np.eye(4)
    truth[:3, :3] = o3d.geometry.get_rotation_matrix_from_quaternion(np.array([w, x, y, z]))
    truth[:3, 3] = document["marker_from_bone"]["t_mm"]
    return truth


def target_error_mm(document, bone_from_marker):
    """How far the target in the bone lands from itself when the true pose brings it to the marker."""
    target = np.append(document["target_mm"], 1.0)
    back = bone_from_marker @ true_marker_from_bone(document) @ target
    return float(np.linalg.norm((back - target)[:3]))


def run(folder):
    bone, bone_feature = read_bone(folder)
    trials = sorted(folder.glob("trial_*.json"), key=lambda file: int(file.stem.split("_")[1]))
    if not trials:
        sys.exit(f"{folder}: no trial_*.json in it")
    for name, method in (("Open3D FPFH + RANSAC", by_ransac), ("Open3D fast global", by_fast_global)):
        errors, seconds = [], []
        for file in trials:
            document = json.loads(file.read_text(encoding="utf-8"))
            start = time.process_time()
            strokes, feature = read_strokes(file.with_suffix(".csv"))
            found = polish(strokes, bone, method(strokes, feature, bone, bone_feature))
            seconds.append(time.process_time() - start)
            errors.append(target_error_mm(document, found))
        right = [error for error in errors if error < SUCCESS_MM]
        of_the_right = f"{statistics.median(right):.2f}" if right else "none"
        print(f"| {document['noise']} | {name} | {len(right)} of {len(errors)} | {statistics.median(errors):.2f} | "
              f"{of_the_right} | {1e3 * statistics.median(seconds):.0f} |", flush=True)


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: open3d_registration.py FOLDER...")
    o3d.utility.random.seed(1)
    print("| noise | method | success | median error, mm | of the successes | ms, median |")
    print("|---|---|---|---|---|---|")
    for folder in sys.argv[1:]:
        run(pathlib.Path(folder))


main()
