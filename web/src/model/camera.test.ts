import { expect, test } from "vitest";
import { type Camera, cameraOf, cameraText } from "./camera";

const free: Camera = { view: "free", vehicle: "", azimuth: -1.5, polar: 0.75, distance: 120.25, at: [10, 0, -35.125] };
const behind: Camera = { view: "chase", vehicle: "car, red", azimuth: 0.25, polar: 1.28, distance: 13 };

test.each([free, behind])("a camera comes back from its address", (camera) => {
  expect(cameraOf(cameraText(camera))).toEqual(camera);
});

test.each([undefined, "", "free", "free,,1,2", "chase,car,1,2,0", "chase,car,a,2,3", "other,,1,2,3,4,5,6", "free,,1,2,3,4,5,6,7"])(
  "%j is no camera",
  (text) => expect(cameraOf(text)).toBeUndefined(),
);
