import { expect, it } from "vitest";
import { planOf, readFacts, scaleBarM } from "../../../src/app/photographs/photographFacts";

it("says where, when and with what a photograph was taken", async () => {
  const facts = await readFacts({ path: "dji/a.jpg", blob: photograph(47.25, -8.5) });
  expect(facts.camera).toBe("Maker M3");
  expect(facts.focalMm).toBeCloseTo(12.29, 2);
  expect(facts.taken?.getFullYear()).toBe(2024);
  expect(facts.position?.latitude).toBeCloseTo(47.25, 6);
  expect(facts.position?.longitude).toBeCloseTo(-8.5, 6);
  expect(facts.position?.altitudeM).toBeCloseTo(512, 6);
});

it("says nothing of a photograph without a header, or of no photograph", async () => {
  const nothing = { camera: null, focalMm: null, taken: null, position: null };
  for (const content of ["", "\xff\xd8\xff\xd9", "PNG?"]) {
    const blob = new Blob([Uint8Array.from(content, (letter) => letter.charCodeAt(0))]);
    expect(await readFacts({ path: "a.jpg", blob })).toEqual({ path: "a.jpg", ...nothing });
  }
});

it("lays positions out in metres, in the order of their times", async () => {
  const at = (path: string, longitude: number, second: number) => ({
    path,
    camera: null,
    focalMm: null,
    taken: new Date(2024, 0, 1, 12, 0, second),
    position: { latitude: 60, longitude, altitudeM: null },
  });
  const plan = planOf([at("b", 10.001, 2), at("a", 10, 1), { ...at("c", 0, 3), position: null }]);
  expect(plan.map(({ path }) => path)).toEqual(["a", "b"]);
  // A degree of longitude is half as long at 60 degrees of latitude.
  expect((plan[1]?.east ?? 0) - (plan[0]?.east ?? 0)).toBeCloseTo(55.66, 1);
  expect(scaleBarM(130)).toBe(20);
  expect(scaleBarM(1)).toBeCloseTo(0.2);
});

/** A JPEG of nothing but an EXIF header, little-endian. */
function photograph(latitude: number, longitude: number): Blob {
  type Entry = readonly [tag: number, type: number, count: number, bytes: readonly number[]];
  const u32 = (value: number) => [0, 8, 16, 24].map((shift) => (value >>> shift) & 255);
  const u16 = (value: number) => [value & 255, value >>> 8];
  const text = (value: string) => [...`${value}\0`].map((letter) => letter.charCodeAt(0));
  const words = (tag: number, value: string): Entry => [tag, 2, value.length + 1, text(value)];
  const ratio = (tag: number, ...values: number[]): Entry => [
    tag,
    5,
    values.length,
    values.flatMap((value) => [...u32(Math.round(value * 1e4)), ...u32(1e4)]),
  ];
  const pointer = (tag: number, at: number): Entry => [tag, 4, 1, u32(at)];
  const directory = (entries: readonly Entry[], start: number) => {
    let data = start + 2 + 12 * entries.length + 4;
    const heads: number[] = [];
    const bodies: number[] = [];
    for (const [tag, type, count, bytes] of entries) {
      heads.push(...u16(tag), ...u16(type), ...u32(count));
      if (bytes.length > 4) {
        heads.push(...u32(data));
        bodies.push(...bytes);
        data += bytes.length;
      } else {
        heads.push(...bytes, ...Array<number>(4 - bytes.length).fill(0));
      }
    }
    return [...u16(entries.length), ...heads, ...u32(0), ...bodies];
  };
  const [mainAt, exifAt, gpsAt] = [8, 100, 200];
  const main = [words(0x10f, "Maker"), words(0x110, "M3"), pointer(0x8769, exifAt), pointer(0x8825, gpsAt)];
  const exif = [words(0x9003, "2024:05:06 10:11:12"), ratio(0x920a, 12.29)];
  const gps: Entry[] = [
    words(1, latitude < 0 ? "S" : "N"),
    ratio(2, Math.abs(latitude), 0, 0),
    words(3, longitude < 0 ? "W" : "E"),
    ratio(4, Math.abs(longitude), 0, 0),
    [5, 1, 1, [0]],
    ratio(6, 512),
  ];
  const tiff = new Uint8Array(360);
  tiff.set([0x49, 0x49, 42, 0, ...u32(mainAt)]);
  tiff.set(directory(main, mainAt), mainAt);
  tiff.set(directory(exif, exifAt), exifAt);
  tiff.set(directory(gps, gpsAt), gpsAt);
  const body = [...text("Exif"), 0, ...tiff];
  const length = body.length + 2;
  return new Blob([
    Uint8Array.from([0xff, 0xd8, 0xff, 0xe1, length >> 8, length & 255, ...body, 0xff, 0xd9]),
  ]);
}
