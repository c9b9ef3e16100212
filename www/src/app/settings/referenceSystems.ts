/** Reference systems by name, and whether coordinates have the size that theirs have. */
import { grouped } from "../parts/numberText";

interface System {
  code: number;
  name: string;
  /** Least and largest easting and northing of the land that it is made for, metres, rounded outwards. */
  east: readonly [number, number];
  north: readonly [number, number];
}

/** Series of zones: first code, first zone and how many, name, and northings. */
const UTM = [
  [32601, 1, 60, "WGS 84 / UTM zone #N", 0, 9_400_000],
  [32701, 1, 60, "WGS 84 / UTM zone #S", 1_000_000, 10_000_000],
  [25828, 28, 11, "ETRS89 / UTM zone #N", 3_000_000, 9_400_000],
  [26901, 1, 23, "NAD83 / UTM zone #N", 1_000_000, 9_400_000],
  [7846, 46, 14, "Australia, GDA2020 / MGA zone #", 3_000_000, 10_000_000],
  [28348, 48, 11, "Australia, GDA94 / MGA zone #", 3_000_000, 10_000_000],
] as const;

/** Code, name, least and largest easting, least and largest northing; both in kilometres. */
const NATIONAL = [
  [2056, "Switzerland, CH1903+ / LV95", 2480, 2840, 1070, 1300],
  [2154, "France, RGF93 / Lambert-93", 80, 1260, 6000, 7200],
  [2157, "Ireland, IRENET95 / Irish Transverse Mercator", 400, 800, 500, 1000],
  [2176, "Poland, ETRF2000 / CS2000 zone 5", 5300, 5700, 5400, 6100],
  [2177, "Poland, ETRF2000 / CS2000 zone 6", 6300, 6700, 5400, 6100],
  [2178, "Poland, ETRF2000 / CS2000 zone 7", 7300, 7700, 5400, 6100],
  [2179, "Poland, ETRF2000 / CS2000 zone 8", 8300, 8700, 5400, 6100],
  [2180, "Poland, ETRF2000 / CS92", 140, 900, 90, 900],
  [2193, "New Zealand, NZGD2000 / Transverse Mercator", 1000, 2200, 4700, 6300],
  [3003, "Italy, Monte Mario / zone 1", 1200, 1900, 3900, 5300],
  [3004, "Italy, Monte Mario / zone 2", 2200, 2950, 3900, 5300],
  [3006, "Sweden, SWEREF99 TM", 180, 1000, 6100, 7700],
  [3059, "Latvia, LKS92 / Latvia TM", 300, 780, 160, 450],
  [3067, "Finland, ETRS89 / TM35FIN", 50, 800, 6600, 7800],
  [3301, "Estonia, L-EST97", 360, 750, 6370, 6640],
  [3346, "Lithuania, LKS94", 300, 690, 5960, 6270],
  [3763, "Portugal, ETRS89 / TM06", -130, 180, -310, 290],
  [3765, "Croatia, HTRS96 / TM", 250, 780, 4670, 5170],
  [3794, "Slovenia, D96 / TM", 370, 630, 20, 200],
  [3812, "Belgium, ETRS89 / Lambert 2008", 500, 800, 500, 760],
  [5514, "Czechia and Slovakia, S-JTSK / Krovak East North", -910, -160, -1340, -930],
  [21781, "Switzerland, CH1903 / LV03", 480, 840, 70, 300],
  [23700, "Hungary, HD72 / EOV", 420, 940, 40, 370],
  [27700, "Great Britain, OSGB36 / National Grid", 0, 700, 0, 1300],
  [28992, "Netherlands, Amersfoort / RD New", -10, 300, 300, 630],
  [31254, "Austria, MGI / GK West", -80, 200, 5100, 5450],
  [31255, "Austria, MGI / GK Central", -130, 200, 5100, 5450],
  [31256, "Austria, MGI / GK East", -180, 120, 5100, 5450],
  [31287, "Austria, MGI / Lambert", 100, 700, 260, 600],
  [31370, "Belgium, BD72 / Lambert 72", 0, 300, 20, 260],
  [31466, "Germany, DHDN / Gauss-Krüger zone 2", 2300, 2800, 5200, 6200],
  [31467, "Germany, DHDN / Gauss-Krüger zone 3", 3200, 3800, 5200, 6200],
  [31468, "Germany, DHDN / Gauss-Krüger zone 4", 4200, 4800, 5200, 6200],
  [31469, "Germany, DHDN / Gauss-Krüger zone 5", 5200, 5800, 5200, 6200],
] as const;

/** Those that have a name here; any other code may be stated as well. */
export const SYSTEMS: readonly System[] = [
  ...UTM.flatMap(([first, zone, count, name, low, high]) =>
    Array.from(
      { length: count },
      (_, i): System => ({
        code: first + i,
        name: name.replace("#", String(zone + i)),
        east: [100_000, 900_000],
        north: [low, high],
      }),
    ),
  ),
  ...NATIONAL.map(
    ([code, name, ...km]): System => ({
      code,
      name,
      east: [km[0] * 1000, km[1] * 1000],
      north: [km[2] * 1000, km[3] * 1000],
    }),
  ),
];

/** The systems whose names have all the words, at their beginnings. */
export function systemsNamed(text: string): System[] {
  const wordsOf = (of: string) => of.toLowerCase().match(/[\p{L}\d]+/gu) ?? [];
  const wanted = wordsOf(text);
  return SYSTEMS.filter(({ name }) => {
    const words = wordsOf(name);
    return wanted.every((one) => words.some((word) => word.startsWith(one)));
  });
}

/** The name of a system, and whether a place has the size of its coordinates; nothing of those that have no name here. */
export function systemWords(
  code: number | null,
  place: readonly [number, number, number] | undefined,
): string {
  const system = SYSTEMS.find((one) => one.code === code);
  if (system === undefined) {
    return "";
  }
  const { name, east, north } = system;
  const outside = ([low, high]: readonly [number, number], at: number) => at < low || at > high;
  if (place === undefined || (!outside(east, place[0]) && !outside(north, place[1]))) {
    return name;
  }
  const range = ([low, high]: readonly [number, number]) => `${grouped(low)} to ${grouped(high)}`;
  const at = `${grouped(Math.round(place[0]))} and ${grouped(Math.round(place[1]))}`;
  return `${name}: its eastings are ${range(east)} and its northings ${range(north)}, but the scene lies at ${at}. Is it another system?`;
}
