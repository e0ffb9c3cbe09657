// The order of pages. A page that is missing here is an error of scripts/site.sh.

/** @param {string} folder @param {Record<string, string>} pages titles by file name */
const items = (folder, pages) => Object.entries(pages).map(([name, text]) => ({ text, link: `/${folder}/${name === "index" ? "" : `${name}.html`}` }));

export const sidebar = [
  {
    text: "Tutorials",
    items: items("tutorials", {
      index: "Where to start",
      "ten-minutes": "Ten minutes with MIMo",
      curiosity: "Curiosity in Python",
      room: "A room with a ball",
      "own-task": "A task of your own in Rust",
      ages: "An experiment with ages",
      page: "MIMo in a page of your own",
      engine: "The engine without an infant",
      switching: "From MuJoCo or the kit",
    }),
  },
  {
    text: "MIMo and his world",
    items: items("guide", {
      index: "Contents",
      mimo: "MIMo's body",
      scenes: "Scenes",
      rooms: "A room of your own",
      tasks: "Behaviors and tasks",
      senses: "Senses",
      actuation: "Actuation",
      growing: "Growing",
      differences: "Infants who differ",
      infant: "How much of an infant is he",
    }),
  },
  {
    text: "Ways in",
    items: [
      ...items("python", { index: "Python", "from-the-kit": "From the starter kit", "from-mimo": "From MIMo", programs: "Public programs", mujoco: "MuJoCo's names", learners: "Learners" }),
      ...items("guide", { rust: "Rust", "own-world": "In a world of your own" }),
      ...items("rust", { engine: "The engine alone" }),
      ...items("guide", { cli: "The command line", web: "In the browser" }),
      ...items("web", { npm: "The npm package" }),
    ],
  },
  {
    text: "Experiments",
    items: items("guide", { benchmark: "Records, measures, benchmarks", movement: "Measures of movement", protocols: "Protocols", motions: "Motions", cluster: "What an hour buys" }),
  },
  {
    text: "Reference",
    items: items("guide", { configuration: "Configuration", glossary: "Glossary" }),
  },
  {
    text: "Results",
    collapsed: true,
    items: [
      ...items("results", { benchmark: "Baselines of self-touch", protocols: "Experiments beside infants", policies: "Trained policies" }),
      ...items("guide", { distance: "Distance to MuJoCo", speed: "Speed" }),
      ...items("results", {
        worlds: "Public models",
        differential: "Random documents",
        "same-bits": "Same bits",
        gpu: "Pictures on a GPU",
        endurance: "Endurance",
        "crash-safety": "Crash safety",
        history: "Figures over time",
        packages: "Other packages' environments",
      }),
    ],
  },
  {
    text: "Before you choose",
    items: [
      ...items("results", { comparison: "How it compares", versions: "Which version works with which" }),
      ...items("guide", { surprises: "What will surprise you", "known-faults": "Known faults" }),
    ],
  },
  {
    text: "The project",
    collapsed: true,
    items: items("project", {
      changes: "Changes",
      contributing: "Contributing",
      architecture: "Architecture",
      adding: "How to add a part",
      security: "Security",
      fuzzing: "Fuzzing",
      "reference-data": "Reference data",
      fragments: "Changes since the last release",
      "code-of-conduct": "Code of conduct",
    }),
  },
];
