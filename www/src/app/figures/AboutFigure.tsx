/** What each stage view shows: a paragraph, its equation, and where it stands in the papers. */
import "./figures.css";
import type { ComponentChildren } from "preact";
import { Linked } from "../glossary/Term";
import type { Tab } from "../state/methods";

export interface FigureText {
  title: string;
  /** Paper, section and figures. */
  source: string;
  text: string;
  equation: ComponentChildren;
  /** What to do here. */
  hint: string;
}

/** A vector: upright and bold. */
const V = ({ children }: { children: ComponentChildren }) => (
  <mi mathvariant="normal" class="v">
    {children}
  </mi>
);

/** A name that is no variable: upright. */
const Up = ({ children }: { children: ComponentChildren }) => <mi mathvariant="normal">{children}</mi>;

const Open = () => <Up>(</Up>;
const Close = () => <Up>)</Up>;

const Sim = () => (
  <mrow>
    <Up>Sim</Up>
    <Open />
    <mi>θ</mi>
    <Close />
  </mrow>
);

export const FIGURES: Record<Tab, FigureText> = {
  images: {
    title: "Views",
    source: "B99 2, figure 1; W96 3.2",
    text: "Each view is a photograph with a known camera P. Lens distortion has been removed, so that a point X, seen from the [[projection-centre]] C, lies at x ≃ P X: both are homogeneous, so the scale is free. All later figures rest on this one equation.",
    equation: (
      <mrow>
        <V>x</V>
        <mo>≃</mo>
        <mi>P</mi>
        <V>X</V>
        <mo>=</mo>
        <mi>K</mi>
        <mi>R</mi>
        <Open />
        <V>X</V>
        <mo>−</mo>
        <V>C</V>
        <Close />
      </mrow>
    ),
    hint: "Scroll to zoom, drag to move. What is selected elsewhere is marked here.",
  },
  segments: {
    title: "Line segments",
    source: "B99 3.2",
    text: "[[edgel|Edgels]] with sub-pixel positions are linked into chains, broken where the tangent turns, and fitted by orthogonal regression: the line l leaves the smallest distances to its edgels x. Red: lines that were rejected, as part of a curve or as texture.",
    equation: (
      <mrow>
        <msup>
          <V>l</V>
          <Up>T</Up>
        </msup>
        <V>x</V>
        <mo>=</mo>
        <mn>0</mn>
      </mrow>
    ),
    hint: "Pick a segment for its length and direction; before matching that is all we know. Rejected lines say why.",
  },
  matches: {
    title: "Matching over views",
    source: "B99 3.1 to 3.4, figures 1 to 5 and 7",
    text: "The end points of a [[segment]] bound an [[epipolar-beam]] in every other view. [[candidate|Candidates]] in it are compared point by point: x′ is where the [[epipolar-line]] of x meets the candidate l′. A pair predicts the line in third views, by their [[trifocal-tensor|trifocal tensors]]; there a segment or, without one, a higher correlation must confirm it.",
    equation: (
      <mrow>
        <V>x′</V>
        <mo>=</mo>
        <V>l′</V>
        <mo>×</mo>
        <Open />
        <mi>F</mi>
        <V>x</V>
        <Close />
      </mrow>
    ),
    hint: "Pick a segment; then choose a candidate and drag the point along it.",
  },
  lines: {
    title: "3D lines",
    source: "B99 3.2 to 3.4, figures 4, 6, 8 and 9",
    text: "A line L has four parameters. They minimise the distances d from the ends of the measured segments (m) to the image of L, over all views j. Merging and growing extend what the segments showed. [[triangulation|Accuracy]] improves with the number of views.",
    equation: (
      <mrow>
        <munder>
          <mo>min</mo>
          <mi>L</mi>
        </munder>
        <munder>
          <mo>∑</mo>
          <mi>j</mi>
        </munder>
        <msup>
          <mi>d</mi>
          <mn>2</mn>
        </msup>
        <Open />
        <msubsup>
          <V>l</V>
          <Up>m</Up>
          <mi>j</mi>
        </msubsup>
        <mo>,</mo>
        <msup>
          <V>l</V>
          <mi>j</mi>
        </msup>
        <Close />
      </mrow>
    ),
    hint:
      "Before growing shows what the segments alone give. The fainter a line, the less certain it is; pick " +
      "it to see what speaks for it and against it. Red lines are too unlikely edges in the finished model, " +
      "or a better line runs along them: the files leave them out.",
  },
  halfplanes: {
    title: "Half-planes",
    source: "B99 4.1, figures 10 to 15",
    text: "A 3D line fixes the plane through it except for one angle, θ. Each θ induces a [[homography]] between the reference view [I | 0] and view i, [A | a]; v is the plane's normal over its distance. At the right θ the neighbourhoods agree: [[similarity|Sim(θ)]] averages the squared correlations at points of interest, weighted by w, the inverse of their distance from the line, over the views that see the side.",
    equation: (
      <mtable displaystyle>
        <mtr>
          <mtd>
            <msup>
              <mi>H</mi>
              <mi>i</mi>
            </msup>
            <Open />
            <mi>θ</mi>
            <Close />
            <mo>=</mo>
            <msup>
              <mi>A</mi>
              <mi>i</mi>
            </msup>
            <mo>+</mo>
            <msup>
              <V>a</V>
              <mi>i</mi>
            </msup>
            <msup>
              <V>v</V>
              <Up>T</Up>
            </msup>
            <Open />
            <mi>θ</mi>
            <Close />
          </mtd>
        </mtr>
        <mtr>
          <mtd>
            <Sim />
            <mo>=</mo>
            <munder>
              <mo>∑</mo>
              <mi>i</mi>
            </munder>
            <msub>
              <mo>∫</mo>
              <Up>POI</Up>
            </msub>
            <mi>w</mi>
            <Open />
            <V>x</V>
            <Close />
          </mtd>
        </mtr>
        <mtr>
          <mtd>
            <mspace width="2em" />
            <mo>·</mo>
            <msup>
              <Up>Cor</Up>
              <mn>2</mn>
            </msup>
            <Open />
            <V>x</V>
            <mo>,</mo>
            <msup>
              <mi>H</mi>
              <mi>i</mi>
            </msup>
            <Open />
            <mi>θ</mi>
            <Close />
            <V>x</V>
            <Close />
          </mtd>
        </mtr>
      </mtable>
    ),
    hint: "Pick a line or a fan, then drag θ: the windows below are alike only at the right angle.",
  },
  coplanar: {
    title: "Coplanar sets",
    source: "B99 2 (Leuven; Moons et al. 1998), 5",
    text: "Lines in one plane are a face of the roof before anything is compared on it. Neighbouring lines are grouped where their ends, as uncertain as they are, more likely lie in one plane than not; the convex hull of the ends is the first polygon. A side without a line may be square to its neighbours, as the share P of the corners of true roofs is, or mirror the one across: c is how far an end is from that, φ the density of the ends' errors, w the length of its side. Then the views verify what is inside.",
    equation: (
      <mrow>
        <mo>ln</mo>
        <Open />
        <mi>w</mi>
        <mi>φ</mi>
        <Open />
        <mi>c</mi>
        <Close />
        <Close />
        <mo>+</mo>
        <mo>ln</mo>
        <mfrac>
          <mi>P</mi>
          <mrow>
            <mn>1</mn>
            <mo>−</mo>
            <mi>P</mi>
          </mrow>
        </mfrac>
        <mo>&gt;</mo>
        <mn>0</mn>
      </mrow>
    ),
    hint: "Pick a polygon: its hull, its lines and its place in every photograph appear, and the inspector weighs each side.",
  },
  adjacency: {
    title: "Adjacency graphs",
    source: "B99 2 (Bonn; Fischer et al. 1998)",
    text: "Ends of segments that more likely meet than lie beside each other by chance make corners; their edges, in order around each, part the image into regions: an [[adjacency-graph]]. A corner is matched over the views as a whole: N is what the distance from its epipolar line or its predicted place says (covariance S), what the directions of its edges say, and the colours of its regions, each against the density ρ of such things by chance. Two edges in space with a region between them propose its plane; corners that an edge joins confirm each other.",
    equation: (
      <mrow>
        <mi>N</mi>
        <mo>=</mo>
        <munder>
          <mo>∑</mo>
          <mi>j</mi>
        </munder>
        <mo>ln</mo>
        <mfrac>
          <mrow>
            <mi>φ</mi>
            <Open />
            <msub>
              <V>x</V>
              <mi>j</mi>
            </msub>
            <mo>−</mo>
            <msub>
              <mi>P</mi>
              <mi>j</mi>
            </msub>
            <V>X</V>
            <mo>;</mo>
            <msub>
              <mi>S</mi>
              <mi>j</mi>
            </msub>
            <Close />
          </mrow>
          <msub>
            <mi>ρ</mi>
            <mi>j</mi>
          </msub>
        </mfrac>
        <mo>&gt;</mo>
        <mn>0</mn>
      </mrow>
    ),
    hint: "Pick a large dot in the image: its edges light up in all views, with the planes of the regions between them.",
  },
  dense: {
    title: "Dense planes",
    source: "B99 2 (ENST); Barnes et al. 2009; Bleyer et al. 2011; Isack and Boykov 2012",
    text: "Where no line starts a plane, the photographs themselves do. On a grid in plan, small slanted patches try the planes of their neighbours and variations of their own, and keep the one on which the views agree best (PatchMatch). The planes of patches that fit together then compete (PEaRL): each patch p gets the plane l for which the views say most, N in nats, or none; neighbours p and q with different planes cost β. Height, roughness, colour and size say what a plane is.",
    equation: (
      <mrow>
        <munder>
          <mo>max</mo>
          <mi>l</mi>
        </munder>
        <munder>
          <mo>∑</mo>
          <mi>p</mi>
        </munder>
        <msub>
          <mi>N</mi>
          <mi>p</mi>
        </msub>
        <Open />
        <msub>
          <mi>l</mi>
          <mi>p</mi>
        </msub>
        <Close />
        <mo>−</mo>
        <mi>β</mi>
        <munder>
          <mo>∑</mo>
          <mrow>
            <mi>p</mi>
            <mo>,</mo>
            <mi>q</mi>
          </mrow>
        </munder>
        <mrow>
          <Up>[</Up>
          <msub>
            <mi>l</mi>
            <mi>p</mi>
          </msub>
          <mo>≠</mo>
          <msub>
            <mi>l</mi>
            <mi>q</mi>
          </msub>
          <Up>]</Up>
        </mrow>
      </mrow>
    ),
    hint: "Pick a patch: its plane lights up, and stems lead to the heights that its patches had by themselves. The inspector says what speaks for a building and against it.",
  },
  groups: {
    title: "Grouping",
    source: "B99 4.2, figures 16 to 20",
    text: "Collinear lines with a common [[half-plane]] are joined; neighbours that lie in one plane within its uncertainty form a group, which gets a new plane by regression over points X of all its lines. The Delaunay triangulation constrained to the projected lines decides which lines are neighbours. In each plane, further lines are found where segments of several views coincide.",
    equation: (
      <mrow>
        <msup>
          <V>n</V>
          <Up>T</Up>
        </msup>
        <V>X</V>
        <mo>+</mo>
        <mi>d</mi>
        <mo>≈</mo>
        <mn>0</mn>
      </mrow>
    ),
    hint: "Pick a group: its lines light up in space and in every view. Green: lines found in a plane.",
  },
  facets: {
    title: "Facets",
    source: "B99 4.3, figures 21 to 23",
    text: "[[border-line|Border lines]] (real lines, new lines, intersections of planes, closing lines) cut the plan into cells, and the planes compete for them. A facet is kept if the views agree inside and enough of its outline, τ, is real. The paper settles conflicts pair by pair, by area times that share; here the same evidence decides for all cells at once.",
    equation: (
      <mrow>
        <mi>S</mi>
        <mo>=</mo>
        <mi>A</mi>
        <mo>·</mo>
        <msub>
          <mi>τ</mi>
          <Up>real</Up>
        </msub>
      </mrow>
    ),
    hint: "Hue: where a facet faces; saturation: how steep it is. Red outlines in the plan were rejected.",
  },
  refinement: {
    title: "Regularisation and refinement",
    source: "B99 2",
    text: "All sides of a building are measured again in every view that sees them, and its planes and corners are adjusted together until the wireframe fits the edges. What roofs mostly are (level, parallel, square, symmetric) is tested one by one: c is how far the free solution is from it. A relation that the images allow is adopted and holds exactly.",
    equation: (
      <mrow>
        <msup>
          <mi>χ</mi>
          <mn>2</mn>
        </msup>
        <mo>=</mo>
        <mfrac>
          <msup>
            <mi>c</mi>
            <mn>2</mn>
          </msup>
          <mrow>
            <mi>J</mi>
            <mi>C</mi>
            <msup>
              <mi>J</mi>
              <Up>T</Up>
            </msup>
            <mo>+</mo>
            <msup>
              <mi>σ</mi>
              <mn>2</mn>
            </msup>
          </mrow>
        </mfrac>
      </mrow>
    ),
    hint: "Orange: outlines before refinement. Pick a dot: its sides light up in space and in every view; what lies left of the dashed line is adopted.",
  },
  model: {
    title: "Model",
    source: "B99 4.4, figures 24 and 25",
    text: "Walls down to the ground make facets into buildings: closed solids, whose V corners, E edges and F faces satisfy Euler's formula wherever no courtyard pierces them. Every face takes its texture from the view that shows it best; hidden parts come from other views.",
    equation: (
      <mrow>
        <mi>V</mi>
        <mo>−</mo>
        <mi>E</mi>
        <mo>+</mo>
        <mi>F</mi>
        <mo>=</mo>
        <mn>2</mn>
      </mrow>
    ),
    hint: "Choose a view instead of the free camera to lay its photograph over the model. Measure distances, slopes and areas.",
  },
  regions: {
    title: "Regions (ORIS)",
    source: "W96 3.3, figure 3",
    text: "The image becomes a partition into [[region|regions]] of constant grey value plus noise, with straight shared boundaries. Break points are dropped and regions merged, always the move that shortens the [[description-length|description]] most: the length L of the model m and of what remains of the image I. It ends when no move does.",
    equation: (
      <mrow>
        <mo>min</mo>
        <mi>L</mi>
        <Open />
        <mi>m</mi>
        <Close />
        <mo>+</mo>
        <mi>L</mi>
        <Open />
        <mi>I</mi>
        <mi mathvariant="normal">|</mi>
        <mi>m</mi>
        <Close />
      </mrow>
    ),
    hint: "Pick a region for its area, mean and variance. Tints only distinguish neighbouring regions.",
  },
  directions: {
    title: "Main directions",
    source: "W96 3.4, figures 4 and 5",
    text: "The [[interpretation-plane]] of every image line is cut with the XY plane. Horizontal lines give the same azimuth α from every view; others scatter. Two perpendicular peaks of the histogram h are found together.",
    equation: (
      <mrow>
        <munder>
          <mo>max</mo>
          <mi>α</mi>
        </munder>
        <mi>h</mi>
        <Open />
        <mi>α</mi>
        <Close />
        <mo>+</mo>
        <mi>h</mi>
        <Open />
        <mi>α</mi>
        <mo>+</mo>
        <mn>90°</mn>
        <Close />
      </mrow>
    ),
    hint: "Blue and orange lines may follow the first and the second direction.",
  },
  clusters: {
    title: "Clusters",
    source: "W96 3.5, figures 6 to 9",
    text: "In the plane across a [[main-direction]], each image line of that direction is a straight line, and a 3D line is a point where lines of several images meet. The points compete by description length: G is by how many bits the description of the image lines gets shorter when they share one [[cluster]]. Colours are views.",
    equation: (
      <mrow>
        <mi>G</mi>
        <mo>=</mo>
        <msub>
          <mi>L</mi>
          <Up>alone</Up>
        </msub>
        <mo>−</mo>
        <msub>
          <mi>L</mi>
          <Up>cluster</Up>
        </msub>
        <mo>&gt;</mo>
        <mn>0</mn>
      </mrow>
    ),
    hint: "Pick a ring: its 3D line is projected back into every view. Small red rings were rejected.",
  },
  rectangles: {
    title: "Rectangular planes",
    source: "W96 3.6, figures 10 to 12",
    text: "Two parallel lines span a plane that is open at two ends. Image lines that cross it at right angles vote for their position along it; the histogram's peaks are its ends. The set S of planes p that do not overlap, with the largest sum of measures M, is the roof.",
    equation: (
      <mrow>
        <munder>
          <mo>max</mo>
          <mi>S</mi>
        </munder>
        <munder>
          <mo>∑</mo>
          <mrow>
            <mi>p</mi>
            <mo>∈</mo>
            <mi>S</mi>
          </mrow>
        </munder>
        <mi>M</mi>
        <Open />
        <mi>p</mi>
        <Close />
      </mrow>
    ),
    hint: "Pick a facet or choose a pair of lines to see its window.",
  },
};

export function AboutFigure({ tab }: { tab: Tab }) {
  const { title, source, text, equation, hint } = FIGURES[tab];
  return (
    <details class="panel about" open data-testid="about">
      <summary>
        <h2>{title}</h2>
        <span class="muted">{source}</span>
      </summary>
      <p>
        <Linked text={text} />
      </p>
      <math display="block">{equation}</math>
      <p class="muted">{hint}</p>
    </details>
  );
}
